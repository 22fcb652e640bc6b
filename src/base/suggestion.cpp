// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "lanthorn/text.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace lanthorn {

namespace {

constexpr std::size_t longest_word = 64;  // longer words are not typing errors
constexpr std::size_t shortest_beginning = 3;

// Optimal string alignment distance: Levenshtein distance in which swapping neighbours costs 1.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Rows i - 2, i - 1 and i of the table of distances between prefixes.
  std::array<std::vector<std::size_t>, 3> rows;
  for (auto& row : rows) row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[2][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::rotate(rows.begin(), rows.begin() + 1, rows.end());
    const std::vector<std::size_t>&two_before = rows[0], &before = rows[1];
    std::vector<std::size_t>& row = rows[2];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return rows[2][b.size()];
}

}  // namespace

std::optional<std::string> nearest_name(std::string_view word, std::span<const std::string> known) {
  if (word.size() > longest_word) return std::nullopt;
  const std::string* best = nullptr;
  std::size_t fewest = 0;
  for (const std::string& name : known) {
    const std::size_t edits = edit_distance(word, name);
    if (3 * edits > std::max<std::size_t>(3, name.size()) || edits >= name.size()) continue;
    if (best && edits >= fewest) continue;
    best = &name;
    fewest = edits;
  }
  if (best) return *best;
  const auto begins = [&](const std::string& name) { return name.starts_with(word); };
  if (word.size() < shortest_beginning || std::count_if(known.begin(), known.end(), begins) != 1) return std::nullopt;
  return *std::find_if(known.begin(), known.end(), begins);
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const auto name = nearest_name(word, known);
  return name ? "; did you mean " + *name + "?" : "";
}

}  // namespace lanthorn
