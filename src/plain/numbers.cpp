// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "plain/type.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <numeric>
#include <type_traits>
#include <utility>
#include <variant>

namespace lanthorn::plain {

namespace {

// Fails unless all rows have the shape of the first one.
Shape shape_of_rows(Reader& reader, const List& list, bool is_integral, const std::string& expected) {
  Shape shape{list.size()};
  if (list.empty()) return shape;
  const Shape row = shape_of(reader, list.front(), is_integral, expected);
  for (const Value& item : list)
    if (shape_of(reader, item, is_integral, expected) != row) reader.fail(expected, list);
  shape.insert(shape.end(), row.begin(), row.end());
  return shape;
}

// Writes numbers of type T, one after the other.
template <class T>
class NumberCopy {
 public:
  NumberCopy(Reader& reader, const std::string& expected, T* out) : reader_(reader), expected_(expected), out_(out) {}

  void add(const Value& data) {
    if (const auto* list = data.as<List>())
      for (const Value& item : *list) add(item);
    else if (const auto* array = data.as<Array>())
      add_array(*array);
    else if (const auto* whole = data.as<std::int64_t>())
      add_number(*whole);
    else if (const auto* large = data.as<std::uint64_t>())
      add_number(*large);
    else
      add_number(std::get<double>(data));
  }

 private:
  void add_array(const Array& array) {
    const std::size_t count = array.count();
    if (array.type == scalar_of<T>()) {
      if (count > 0) std::memcpy(out_, array.data, count * sizeof(T));
      out_ += count;
      return;
    }
    with_type(array.type, [&](const auto* type) {
      std::decay_t<decltype(*type)> number{};
      for (std::size_t i = 0; i < count; ++i) {
        std::memcpy(&number, array.data + i * sizeof(number), sizeof(number));
        add_number(number);
      }
    });
  }

  template <class Number>
  void add_number(Number number) {
    if constexpr (std::is_integral_v<T> && std::is_integral_v<Number>) {
      if (!std::in_range<T>(number)) fail_range(number);
    }
    *out_++ = static_cast<T>(number);  // NOLINT(bugprone-signed-char-misuse): int8 is a number here
  }

  template <class Number>
  [[noreturn]] void fail_range(Number number) const {
    using Large = std::conditional_t<std::is_signed_v<Number>, std::int64_t, std::uint64_t>;
    reader_.fail(expected_ + " in range", static_cast<Large>(number));
  }

  Reader& reader_;
  const std::string& expected_;
  T* out_;
};

}  // namespace

std::optional<double> number_of(const Value& value) {
  if (const auto* number = value.as<double>()) return *number;
  if (const auto* whole = value.as<std::int64_t>()) return static_cast<double>(*whole);
  if (const auto* large = value.as<std::uint64_t>()) return static_cast<double>(*large);
  return std::nullopt;
}

Shape shape_of(Reader& reader, const Value& data, bool is_integral, const std::string& expected) {
  if (const auto* list = data.as<List>()) return shape_of_rows(reader, *list, is_integral, expected);
  if (const auto* array = data.as<Array>()) {
    if (is_integral && !is_integer(array->type) && array->count() > 0) reader.fail(expected, data);
    return array->shape;
  }
  if (!number_of(data) || (is_integral && data.as<double>() != nullptr)) reader.fail(expected, data);
  return {};
}

void copy_numbers(Reader& reader, const Value& data, Scalar scalar, void* out, const std::string& expected) {
  with_type(scalar, [&](const auto* type) {
    using T = std::decay_t<decltype(*type)>;
    NumberCopy<T>(reader, expected, static_cast<T*>(out)).add(data);
  });
}

void require_finite(const Reader& reader, Scalar scalar, const void* numbers, std::size_t count, std::size_t row) {
  with_type(scalar, [&](const auto* type) {
    using T = std::decay_t<decltype(*type)>;
    if constexpr (std::is_floating_point_v<T>) {
      const T* const all = static_cast<const T*>(numbers);
      const T* const bad = std::find_if(all, all + count, [](T x) { return !std::isfinite(x); });
      if (bad != all + count)
        reader.fail("expected finite numbers, got " + std::to_string(*bad) + " in entry " +
                    std::to_string(static_cast<std::size_t>(bad - all) / row));
    }
  });
}

Array array_of(Scalar scalar, Shape shape, const void* numbers) {
  Array array{.type = scalar, .shape = std::move(shape)};
  const auto* const first = static_cast<const std::byte*>(numbers);
  const auto owner = std::make_shared<const std::vector<std::byte>>(first, first + array.count() * bytes_of(scalar));
  array.owner = owner;
  array.data = owner->data();
  return array;
}

template <class T>
NumberArray<T> number_array(Reader& reader, const Value& data, const std::string& expected) {
  NumberArray<T> array{shape_of(reader, data, std::is_integral_v<T>, expected), {}};
  array.values.resize(
      std::accumulate(array.shape.begin(), array.shape.end(), std::size_t{1}, std::multiplies<std::size_t>()));
  copy_numbers(reader, data, scalar_of<T>(), array.values.data(), expected);
  return array;
}
template NumberArray<float> number_array(Reader& reader, const Value& data, const std::string& expected);
template NumberArray<double> number_array(Reader& reader, const Value& data, const std::string& expected);

}  // namespace lanthorn::plain
