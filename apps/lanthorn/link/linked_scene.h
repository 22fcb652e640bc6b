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
  /// Applies an update: parts to add or to replace, by table and name, and names of parts to remove; `camera`, `film`,
  /// `filter`, `hints`, `environment` and `color_space` are single parts. Returns the edit to apply to a render of the
  /// previous scene. Throws Error, and leaves the scene unchanged, if the result is not a valid scene.
  RenderEdit update(const plain::Value* set, const plain::Value* remove);

  /// Builds the scene if necessary. Throws Error as `build_scene` does.
  SharedScene build();
  const ViewDescription& view() const { return view_; }

 private:
  using Table = std::map<std::string, plain::Value>;
  struct Parts {
    std::map<std::string, Table> tables;
    Table singles;
  };
  /// Built once, by whoever needs it first; edits then apply to it.
  struct Built {
    std::optional<SceneDescription> description;
    SharedScene scene{};
    std::string problem{};                      ///< why it could not be built
    std::vector<std::string> material_names{};  ///< in the description's order
  };
  struct Changes {
    std::set<std::string> singles;
    std::map<std::string, std::set<std::string>> entries;  ///< replaced, by table
    bool is_other_scene = false;                           ///< parts were added or removed
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
  SceneEdits edits_;  ///< relative to `built_`
};

}  // namespace lanthorn::program
