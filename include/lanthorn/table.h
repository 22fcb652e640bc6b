// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace lanthorn::description {

/// A list of a description, used like a vector. Copies share their entries until one of them changes, so that copies
/// cost nothing and can be recognised as unchanged without a look at their entries. All access that is not const counts
/// as a change.
template <class T>
class Table {
 public:
  using value_type = T;

  Table() = default;
  Table(std::vector<T> entries) { edit() = std::move(entries); }
  Table(std::initializer_list<T> entries) { edit() = entries; }

  /// True if the tables are empty, or copies that have not changed since: their entries are equal, except for what
  /// `take` took.
  friend bool is_same(const Table& a, const Table& b) { return a.identity_ == b.identity_ || (a.empty() && b.empty()); }
  /// The entries, to be changed.
  std::vector<T>& edit() {
    if (identity_.use_count() != 1) identity_ = std::make_shared<char>();
    return unshared();
  }
  /// The entries, for moving their large data away. Copies still count as the same table.
  std::vector<T>& take() {
    is_taken_ = true;
    return unshared();
  }
  bool is_taken() const { return is_taken_ && !empty(); }

  const std::vector<T>& entries() const {
    static const std::vector<T> none;
    return entries_ ? *entries_ : none;
  }
  operator const std::vector<T>&() const { return entries(); }
  std::size_t size() const { return entries().size(); }
  bool empty() const { return entries().empty(); }
  auto begin() const { return entries().begin(); }
  auto end() const { return entries().end(); }
  const T& operator[](std::size_t i) const { return entries()[i]; }
  const T& at(std::size_t i) const { return entries().at(i); }
  const T& front() const { return entries().front(); }
  const T& back() const { return entries().back(); }

  auto begin() { return edit().begin(); }
  auto end() { return edit().end(); }
  T& operator[](std::size_t i) { return edit()[i]; }
  T& at(std::size_t i) { return edit().at(i); }
  T& front() { return edit().front(); }
  T& back() { return edit().back(); }
  void reserve(std::size_t count) { edit().reserve(count); }
  void resize(std::size_t count) { edit().resize(count); }
  void push_back(T entry) { edit().push_back(std::move(entry)); }
  template <class... Arguments>
  T& emplace_back(Arguments&&... arguments) {
    return edit().emplace_back(std::forward<Arguments>(arguments)...);
  }
  void clear() { *this = {}; }

 private:
  std::vector<T>& unshared() {
    if (entries_.use_count() != 1) entries_ = std::make_shared<std::vector<T>>(entries());
    return *entries_;
  }

  std::shared_ptr<std::vector<T>> entries_;
  std::shared_ptr<const char> identity_;  // of the entries, whether or not parts of them were taken
  bool is_taken_ = false;
};

}  // namespace lanthorn::description
