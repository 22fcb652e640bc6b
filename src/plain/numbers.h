// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Arrays of numbers, or nested lists of numbers.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "lanthorn/plain_data.h"

namespace lanthorn::plain {

/// The value as a number; nullopt for everything else, including True and False.
std::optional<double> number_of(const Value& value);

/// The shape of an array or of nested lists of numbers; a single number has no extents. Fails if `data` is neither, if
/// rows have different lengths, and for fractions where whole numbers are required.
Shape shape_of(Reader& reader, const Value& data, bool is_integral, const std::string& expected);

/// Copies the numbers of an array or of nested lists, whose shape is known, to `out`. Fails for numbers out of range.
void copy_numbers(Reader& reader, const Value& data, Scalar scalar, void* out, const std::string& expected);

/// Fails for the first of `count` numbers, in rows of `row`, that is infinite or NaN.
void require_finite(const Reader& reader, Scalar scalar, const void* numbers, std::size_t count, std::size_t row);

/// An array of its own with a copy of the numbers.
Array array_of(Scalar scalar, Shape shape, const void* numbers);

}  // namespace lanthorn::plain
