// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "page.h"

#include <string_view>

namespace lanthorn::program {

// The files of serve/page; the build generates these definitions.
extern const std::string_view page_document, page_style, page_program;

namespace {

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
}

}  // namespace

std::string page_html(const std::string& nonce) {
  std::string page(page_document);
  replace_all(page, "{{nonce}}", nonce);
  replace_all(page, "{{style}}", page_style);
  replace_all(page, "{{program}}", page_program);
  return page;
}

}  // namespace lanthorn::program
