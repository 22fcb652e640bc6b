// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// The program's answers to a client (docs/protocol.md).
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "lanthorn/interactive_render.h"
#include "lanthorn/plain_value.h"
#include "linked_scene.h"

namespace lanthorn::program {

struct LinkAnswer {
  nlohmann::json body;
  std::vector<float> numbers{};  ///< the message's arrays
};

class Conversation {
 public:
  /// Answers an invalid request with "error" and the reason; such a request changes nothing.
  LinkAnswer answer(const plain::Dict& request);

 private:
  LinkAnswer hello(const plain::Dict& request) const;
  LinkAnswer update(const plain::Dict& request);
  LinkAnswer start(const plain::Dict& request);
  LinkAnswer wait(const plain::Dict& request);
  LinkAnswer finish_pass(const plain::Dict& request);
  LinkAnswer stop(const plain::Dict& request);
  LinkAnswer answer_checked(const plain::Dict& request);
  InteractiveSnapshot wait_for_news(std::uint64_t after, double patience) const;

  LinkedScene scene_;
  std::unique_ptr<InteractiveRender> render_;
};

}  // namespace lanthorn::program
