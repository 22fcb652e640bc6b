// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// A scene as the GPU draws it: triangles, materials reduced to the closures of bsdf.glsl. Also tells
// environments apart.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/object.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "lanthorn/scene.h"
#include "math/vec.h"
#include "realtime/scene/layouts.h"
#include "realtime/scene/materials.h"
#include "scene/geometry.h"
#include "scene/scene.h"

namespace lanthorn {

/// The materials that eye paths draw: those whose flags, masked by `looked_at`, equal `wanted`.
struct EyePaths {
  std::uint32_t looked_at = 0, wanted = 0;
  bool has_mirrors = false;  ///< also the delta lobes of other materials

  friend bool operator==(const EyePaths&, const EyePaths&) = default;
};
inline constexpr EyePaths no_eye_paths{0, gpu::flag_traced, false},
    all_eye_paths{gpu::flag_traced, gpu::flag_traced, true},
    needed_eye_paths{gpu::flag_traced | gpu::flag_stand_in, gpu::flag_traced, true},
    glass_eye_paths{gpu::flag_glass, gpu::flag_glass, false};
/// True if these eye paths find all of its light.
inline bool is_drawn_by_paths(const GpuMaterial& m, const EyePaths& eye_paths) {
  return (m.flags & eye_paths.looked_at) == eye_paths.wanted;
}

/// For a program that includes bsdf.glsl.
void set_eye_paths(const gl::Program& program, const EyePaths& eye_paths);

/// Share of rays that do not pass through a mesh of the scene's model at texture coordinates (u, v).
float opacity_at(const ShapeStore& shape, const Vec2& uv);
/// The shapes of a scene in the order of the meshes of its model.
std::vector<const ShapeStore*> shapes_of(const Scene& scene);

/// Radiance from directions all around, and from one direction of each light, by which environments are told apart:
/// edits change their strength or colour.
std::vector<Vec3> environment_fingerprint(const Scene& scene);

/// One command of glMultiDrawElementsIndirect.
struct DrawCommand {
  std::uint32_t count = 0, instances = 1, first_index = 0, base_vertex = 0, draw = 0;
};

/// Immutable except for the places of instances and the colours of lights.
class GpuScene {
 public:
  /// A context must be current. Reads no files.
  explicit GpuScene(const Scene& scene);

  /// Takes over places, materials and lights of an edited scene with the same meshes.
  void update(const Scene& scene);

  /// Draws all triangles. A program with the vertex shader scene.vert.glsl, or one with its inputs, must be in use.
  void draw() const { draw(commands_); }
  /// The same without the shapes that are hidden from the camera.
  void draw_for_camera() const { draw(camera_commands_); }
  /// Binds the resources that scene.glsl and bsdf.glsl name.
  void bind() const;

  std::uint64_t triangles() const { return triangles_; }
  const BoundingSphere& sphere() const { return sphere_; }
  /// Largest distance of a triangle from the surface that it stands for, m.
  float largest_slack() const;
  /// Differences between the picture of the GPU and the scene, as text for the user; empty if there are none.
  const std::vector<std::string>& limitations() const { return limitations_; }
  /// A number, from 1 on, that changes whenever places or materials may have changed.
  std::uint64_t surface_version() const { return surface_version_; }
  /// Corners and indices of all meshes, as `draws` names them; wait for the GPU.
  std::vector<GpuVertex> read_vertices() const {
    return vertices_.read<GpuVertex>(vertices_.bytes() / sizeof(GpuVertex));
  }
  std::vector<std::uint32_t> read_indices() const {
    return indices_.read<std::uint32_t>(indices_.bytes() / sizeof(std::uint32_t));
  }
  /// True if emission or opacity varies over some surface, or rays pass through it.
  bool has_patterns() const;
  const std::vector<GpuDraw>& draws() const { return draw_data_; }
  const std::vector<GpuMaterial>& materials() const { return material_data_; }
  /// True if the CPU's eye paths find all or part of the light of some material.
  bool has_eye_paths() const;
  /// True if the GPU has approximations for some of these materials.
  bool has_stand_ins() const;

 private:
  void make_materials(const Scene& scene, std::vector<SurfaceLayer>& layers);
  void make_draws(const Scene& scene, std::vector<SurfaceLayer>& layers);
  void make_patterns(const Scene& scene, const std::vector<const ShapeStore*>& shapes,
                     std::vector<SurfaceLayer>& layers);
  void add_draw(const GeometryRecord& record, std::size_t mesh, const Transform& to_world, std::uint32_t first_light);
  void upload_draws(const std::vector<const ShapeStore*>& shapes);
  void draw(const gl::Buffer& commands) const;
  void make_vertex_array();

  std::vector<std::uint32_t> first_index_, base_vertex_, index_count_;  // by mesh
  std::vector<float> slack_;                                            // by mesh
  std::vector<GpuDraw> draw_data_;
  std::vector<GpuMaterial> material_data_;
  std::vector<std::string> limitations_;
  gl::Buffer vertices_, indices_, draws_, commands_, camera_commands_, draw_numbers_, materials_;
  SurfaceTextures textures_;
  gl::Texture plastic_albedo_, environment_;
  std::vector<Vec3> environment_fingerprint_;
  gl::VertexArray vertex_array_;
  std::uint64_t triangles_ = 0, surface_version_ = 0;
  BoundingSphere sphere_;
};

}  // namespace lanthorn
