// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "io/pbrt/assembler.h"
#include "io/pbrt/tokenizer.h"

namespace lanthorn::pbrt {

/// The files being read, outermost first, and the names of all files read so far.
struct FileStack {
  std::vector<std::filesystem::path> open;
  std::deque<std::string> names;  ///< a deque, because places point to them
};

/// Reads one file of the scene and the files that it includes. Turns tokens into directives with their parameters and
/// passes them to the assembler. Throws Error with file, line and column.
class Parser {
 public:
  /// `text` must outlive the parser. The other arguments must outlive the whole reading of the scene.
  Parser(std::string_view text, const std::string& name, FileStack& files, Assembler& assembler, Context& context);

  /// Reads all directives up to the end of the text. Returns the place of the end.
  Place parse();

 private:
  using Handler = void (Parser::*)(Place);
  static Handler handler(std::string_view directive);

  Token next();
  std::string expect_string(const char* what);
  float expect_number();
  template <std::size_t N>
  std::array<float, N> expect_numbers();
  Mat4 expect_matrix();

  Parameters parameters();
  Parameter parameter();
  Parameter::Values values(const Parameter& parameter);
  template <class T, class Read>
  std::vector<T> read_values(Read&& read);

  void directive(const Token& token);
  void look_at(Place place);
  void translate(Place place);
  void rotate_by(Place place);
  void scale_by(Place place);
  void transform(Place place);
  void concat_transform(Place place);
  void identity(Place place);
  void coordinate_system(Place place);
  void coord_sys_transform(Place place);
  void active_transform(Place place);
  void transform_times(Place place);
  void transform_begin(Place place);
  void transform_end(Place place);
  void world_end(Place place);
  void option(Place place);
  void texture(Place place);
  void medium_interface(Place place);
  void accelerator(Place place);
  void include(Place place);
  void import(Place place);
  void read_included(const std::string& name, Place place);
  /// Directives of the form `Directive "kind" parameters…`, `Directive "name"` and `Directive`.
  template <void (Assembler::*call)(const std::string&, Parameters, Place)>
  void with_parameters(Place place);
  template <void (Assembler::*call)(const std::string&, Place)>
  void with_name(Place place);
  template <void (Assembler::*call)(Place)>
  void alone(Place place);

  const std::string& name_;
  Tokenizer tokens_;
  Token ahead_;
  FileStack& files_;
  Assembler& assembler_;
  Context& context_;
};

}  // namespace lanthorn::pbrt
