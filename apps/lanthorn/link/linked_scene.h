// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The scene that a client describes part by part.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "lanthorn/description_data.h"
#include "lanthorn/interactive_render.h"
#include "lanthorn/plain_value.h"
#include "lanthorn/scene.h"

namespace lanthorn::program {

class LinkedScene {
 public:
  /// Applies an update: parts to add or to replace, by table and name, and names of parts to remove; `camera`, `film`,
  /// `filter`, `hints`, `environment` and `color_space` are single parts. Returns the edit to apply to a render of the
  /// previous scene. Throws Error, and leaves the scene unchanged, if the result is not a valid description.
  RenderEdit update(const plain::Value* set, const plain::Value* remove);

  /// Builds the scene. No render may run. Throws Error as `build_scene` does.
  SharedScene build();
  const ViewDescription& view() const { return description_->description().view; }

 private:
  using Table = std::map<std::string, plain::Value>;
  /// Copies share the tables.
  struct Parts {
    std::map<std::string, std::shared_ptr<const Table>> tables;
    std::map<std::string, plain::Value> singles;
  };
  using Names = std::set<std::string>;  ///< of tables and single parts

  static Table& changed_table(Parts& parts, const std::string& name);
  static void take_away(Parts& parts, const plain::Dict& remove, Names& changed);
  static void put(Parts& parts, const plain::Dict& set, Names& changed);
  static plain::Dict data_of(const Parts& parts, const Names* names = nullptr);

  Parts parts_;
  std::optional<PartialDescription> description_;
  /// The last scene that was built, to share with. The thread of the render sets it, or `build` if none runs.
  std::shared_ptr<SharedScene> scene_ = std::make_shared<SharedScene>();
};

}  // namespace lanthorn::program
