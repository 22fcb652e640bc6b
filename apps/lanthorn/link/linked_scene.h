// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The scene that a client describes part by part.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lanthorn/interactive_render.h"
#include "lanthorn/plain_value.h"
#include "lanthorn/scene.h"

namespace lanthorn::program {

class LinkedScene {
 public:
  /// What an update asks for: parts to add or to replace, by table and name, and names of parts to take away; `camera`,
  /// `film`, `filter`, `hints`, `environment` and `color_space` are parts of their own. Returns the change, for a
  /// render of the scene as it was before. Throws Error, and leaves the scene as it was, if the result is no scene.
  RenderEdit update(const plain::Value* set, const plain::Value* remove);

  /// Builds the scene, if that was not done yet. Throws Error as `build_scene`.
  SharedScene build();
  const ViewDescription& view() const { return view_; }

 private:
  using Table = std::map<std::string, plain::Value>;
  struct Parts {
    std::map<std::string, Table> tables;
    Table singles;
  };
  /// What is built once, by whoever needs it first, and the replacements upon it.
  struct Built {
    std::optional<SceneDescription> description;
    SharedScene scene{};
    std::string problem{};                      ///< why it could not be built
    std::vector<std::string> material_names{};  ///< in the description's order
  };
  struct Changes {
    std::set<std::string> singles;
    std::map<std::string, std::set<std::string>> entries;  ///< replaced, by table
    bool is_other_scene = false;                           ///< parts have come or gone
  };

  static SharedScene scene_of(Built& built);
  static void take_away(Parts& parts, const plain::Dict& remove, Changes& changes);
  static void put(Parts& parts, const plain::Dict& set, Changes& changes);
  static Changes merge(Parts& parts, const plain::Value* set, const plain::Value* remove);
  static plain::Dict data_of(const Parts& parts);
  bool can_edit(const SceneDescription& description, const Changes& changes) const;
  void note_edits(const SceneDescription& description, const Changes& changes);
  RenderEdit change_of(SceneDescription description, const Changes& changes);

  Parts parts_;
  ViewDescription view_;
  std::shared_ptr<Built> built_ = std::make_shared<Built>();
  SceneEdits edits_;  ///< upon built_
};

}  // namespace lanthorn::program
