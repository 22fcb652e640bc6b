// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// What the server answers: the page, frames, edits and downloads, to those who know the token.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "../output.h"
#include "http_message.h"
#include "http_server.h"
#include "viewer.h"

namespace lanthorn::program {

class ViewService {
 public:
  /// `display`: how the page shows pictures at first. `title`: of the page, and the name of files without extension:
  /// letters, digits, '.', '-' and '_'. `host_name`: by which clients may call this machine, besides localhost and
  /// addresses in numbers; or empty.
  ViewService(Viewer& viewer, const OutputSettings& display, std::string title, std::string token,
              std::string host_name);

  /// GET /TOKEN/ the page; /TOKEN/scene its lights and warnings, as JSON; /TOKEN/frame?after=NUMBER&layer=NAME the next
  /// frame (see `PageFrame::encoded`), or 204 if there is none for ten seconds; /TOKEN/picture.png?exposure=STOPS&
  /// curve=none|filmic|agx&layer=NAME and /TOKEN/picture.exr the last picture. POST /TOKEN/edit an edit as JSON: any of
  /// camera (eye, target, up), lens (fov, aperture, focus: as the options; focus_at: a pixel), environment (source,
  /// rotation, scale), lights (factors by name), method, size, paused, denoise, moving, home. All else is not found.
  HttpResponse answer(const HttpRequest& request, const IsGone& is_gone) const;

 private:
  HttpResponse answer_get(const std::string& resource, const HttpRequest& request, const IsGone& is_gone) const;
  HttpResponse page() const;
  HttpResponse scene() const;
  HttpResponse frame(const HttpRequest& request, const IsGone& is_gone) const;
  HttpResponse png(const HttpRequest& request) const;
  HttpResponse exr() const;
  std::vector<unsigned char> exr_of(const PageFrame& frame) const;
  HttpResponse edit(const HttpRequest& request) const;

  Viewer& viewer_;
  OutputSettings display_;
  std::string title_, token_, host_name_;
  mutable std::mutex encoding_;  // of files, one at a time: they may be large
};

}  // namespace lanthorn::program
