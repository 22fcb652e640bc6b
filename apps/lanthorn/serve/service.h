// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Answers requests for the page, frames, edits and downloads from clients that know the token.
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
  /// `display`: initial display settings of the page. `title`: of the page, and the base name of its files: letters,
  /// digits, '.', '-' and '_'. `host_name`: name that clients may use for this machine, besides localhost and numeric
  /// addresses; or empty.
  ViewService(Viewer& viewer, const OutputSettings& display, std::string title, std::string token,
              std::string host_name);

  /// GET /TOKEN/ returns the page; /TOKEN/scene its lights and warnings as JSON; /TOKEN/frame?after=NUMBER&layer=NAME
  /// the next frame (see `PageFrame::encoded`), or 204 if none appears within ten seconds;
  /// /TOKEN/picture.png?exposure=STOPS&curve=none|filmic|agx&layer=NAME and /TOKEN/picture.exr the last picture. POST
  /// /TOKEN/edit takes an edit as JSON, with any of: camera (eye, target, up), lens (fov, aperture, focus: as the
  /// options; focus_at: a pixel), environment (source, rotation, scale), lights (factors by name), method, size,
  /// paused, denoise, moving, home. All other paths return 404.
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
  mutable std::mutex encoding_;  // serialises file encoding, because files may be large
};

}  // namespace lanthorn::program
