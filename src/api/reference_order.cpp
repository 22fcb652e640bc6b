// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "api/reference_order.h"

#include "lanthorn/text.h"

namespace lanthorn::plain {

namespace {

// Depth-first traversal along references.
class ReferenceOrder {
 public:
  ReferenceOrder(Reader& reader, const Dict& table) : reader_(reader) {
    for (const Dict::Entry& entry : table.entries()) places_.emplace(entry.first, Place{&entry, Mark::unseen});
    for (const Dict::Entry& entry : table.entries()) visit(entry.first);
  }
  std::vector<const Dict::Entry*> take() { return std::move(order_); }

 private:
  enum class Mark : std::uint8_t { unseen, open, done };
  struct Place {
    const Dict::Entry* entry;
    Mark mark;
  };

  // Unknown names are left to the reader, which reports them.
  void visit(const std::string& name) {
    const auto found = places_.find(name);
    if (found == places_.end() || found->second.mark == Mark::done) return;
    if (found->second.mark == Mark::open) reader_.fail(in_quotes(name) + " refers to itself");
    found->second.mark = Mark::open;
    visit_references(found->second.entry->second);
    found->second.mark = Mark::done;
    order_.push_back(found->second.entry);
  }

  void visit_name(const Value& name) {
    if (name.as<std::string>() != nullptr) visit(*name.as<std::string>());
  }

  void visit_references(const Value& value) {
    if (const auto* list = value.as<List>())
      for (const Value& item : *list) visit_references(item);
    if (const auto* dict = value.as<Dict>())
      for (const auto& [key, item] : dict->entries()) {
        if (key == "texture") visit_name(item);
        if (key == "materials" && item.as<List>() != nullptr)
          for (const Value& name : *item.as<List>()) visit_name(name);
        visit_references(item);
      }
  }

  Reader& reader_;
  std::map<std::string, Place> places_;
  std::vector<const Dict::Entry*> order_;
};

}  // namespace

std::vector<const Dict::Entry*> in_reference_order(Reader& reader, const Dict& table) {
  return ReferenceOrder(reader, table).take();
}

}  // namespace lanthorn::plain
