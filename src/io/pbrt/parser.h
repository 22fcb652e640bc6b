// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/pbrt/context.h"
#include "io/pbrt/directive.h"
#include "io/pbrt/tokenizer.h"

namespace lanthorn::pbrt {

/// The files being read, outermost first, and the names of all files read so far.
struct FileStack {
  std::vector<std::filesystem::path> open;
  std::deque<std::string> names;  ///< a deque, because places point to them
};

/// Reads one file of the scene and the files that it includes. Turns tokens into directives with their parameters and
/// passes them to the sink. Throws Error with file, line and column.
class Parser {
 public:
  /// `text` must outlive the parser. The other arguments must outlive the whole reading of the scene.
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

  const std::string& name_;
  Tokenizer tokens_;
  Token ahead_;
  FileStack& files_;
  const DirectiveSink& sink_;
  Context& context_;
};

}  // namespace lanthorn::pbrt
