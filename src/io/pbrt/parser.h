// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/pbrt/context.h"
#include "io/pbrt/directive.h"
#include "io/pbrt/tokenizer.h"

namespace lanthorn::pbrt {

/// The files being read, outermost first, and totals of what has been read.
struct FileStack {
  std::vector<std::filesystem::path> open;
  std::set<std::string> names;  ///< each once, however often included; a set, because places point to them
  std::size_t bytes_left = std::size_t{16} << 30;  ///< for all inclusions together
  /// Limit for repeated inclusions: a few files that each include the next twice would be read 2^64 times.
  static constexpr std::size_t most_repeated_bytes = std::size_t{1} << 30;
  std::size_t repeated_bytes_left = most_repeated_bytes;
};

/// Reads a file of the scene and the files that it includes. Turns tokens into directives with their parameters and
/// passes them to the sink. Throws Error with file, line and column.
class Parser {
 public:
  /// `text` must outlive the parser; the other arguments must outlive the reading of the whole scene.
  Parser(std::string_view text, const std::string& name, FileStack& files, const DirectiveSink& sink, Context& context);

  /// Reads all directives up to the end of the text. Returns the place of the end.
  Place parse();

 private:
  Token next();
  std::string expect_string(std::string_view what);
  void expect_numbers(const DirectiveForm& form, Directive& directive);

  Parameters parameters();
  Parameter parameter();
  Parameter::Values values(const Parameter& parameter);
  template <class T, class Read>
  std::vector<T> read_values(Read&& read);

  void directive(const Token& token);
  void expect_words(Directive& directive);
  void include(const Directive& directive);
  std::string read_included(const std::filesystem::path& path, Place place);

  const std::string& name_;
  Tokenizer tokens_;
  Token ahead_;
  FileStack& files_;
  const DirectiveSink& sink_;
  Context& context_;
};

}  // namespace lanthorn::pbrt
