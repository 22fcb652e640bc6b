// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "realtime/scene/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "light/light.h"
#include "math/sampling.h"
#include "realtime/scene/materials.h"
#include "scene/scene_data.h"
#include "spectrum/wavelengths.h"

namespace lanthorn {

namespace {

/// Bound of the distance of the triangles of `model_of` from a quadric that is not flat, in the shape's space: the
/// sagittas of arcs of 2π / 64 in both directions. Emitters stay inside their true surfaces, on which their light
/// starts.
float slack_of(const ShapeStore& shape) {
  const bool is_round = shape.record.kind == GeometryRecord::Kind::quadric && shape.quadric.kind != Quadric::Kind::disk;
  if (!is_round || shape.record.emits) return 0;
  const Bounds box = shape.bounds();
  return max_component(box.max - box.min) * (1 - std::cos(pi / 64));
}

std::vector<GpuVertex> vertices_of(const SceneMesh& mesh) {
  std::vector<GpuVertex> vertices(mesh.positions.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    vertices[i].position = mesh.positions[i];
    if (!mesh.normals.empty()) vertices[i].normal = mesh.normals[i];
    if (mesh.uvs.empty()) continue;
    vertices[i].u = mesh.uvs[i].x;
    vertices[i].v = mesh.uvs[i].y;
  }
  return vertices;
}

/// Radiance of a surface's first light at texture coordinates (u, v), along its normal; a: 1 if both sides emit.
glm::vec4 emission_of(const Scene& scene, std::uint32_t light, const Vec2& uv) {
  const auto* area = std::get_if<AreaLight>(&scene.lights()[light]);
  if (area == nullptr || area->invisible) return glm::vec4(0);
  EmitterPoint at = sample_area(area->shape, Vec2(0.5f));
  if (area->flip_normal) at.normal = -at.normal;
  const Spectrum radiance = area->emitted({at.point, at.normal, uv}, at.normal, Wavelengths::rgb(0.5f));
  return {radiance[0], radiance[1], radiance[2], area->two_sided ? 1.0f : 0.0f};
}

/// Largest radiance over the unit square, by channel; the alpha channel is as in `emission_of`.
glm::vec4 largest_emission(const Scene& scene, std::uint32_t light) {
  glm::vec4 largest(0);
  for (const glm::vec4& probe : probe_square([&](const Vec2& uv) { return emission_of(scene, light, uv); }))
    largest = glm::max(largest, probe);
  return largest;
}

bool has_picture(const Scene& scene, std::uint32_t light) {
  const auto* area = std::get_if<AreaLight>(&scene.lights()[light]);
  return area != nullptr && area->pattern != nullptr && !area->invisible;
}

bool is_cut_out(const ShapeStore& shape) { return shape.alpha.node || shape.alpha.value < 1; }

/// The infinite lights that the camera sees as one equirectangular image around +y, W/(m² sr).
gl::Texture make_environment(const Scene& scene) {
  float across = 64;
  std::vector<std::uint32_t> seen;
  for (const std::uint32_t light : scene.infinite_lights()) {
    if (is_hidden_from_camera(scene.lights()[light])) continue;
    seen.push_back(light);
    across = std::max(across, texels_across_right_angle(scene.lights()[light]));
  }
  const int width = seen.empty() ? 1 : 4 * std::min(static_cast<int>(across), 1024);
  const int height = std::max(1, width / 2);
  std::vector<glm::vec4> texels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), glm::vec4(0));
  const Wavelengths w = Wavelengths::rgb(0.5f);
  const Point from = scene.bounding_sphere().centre;
  parallel_for(0, seen.empty() ? 0 : height, [&](int y) {
    const float polar = pi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    for (int x = 0; x < width; ++x) {
      const float azimuth = 2 * pi * (static_cast<float>(x) + 0.5f) / static_cast<float>(width) - pi;
      const Direction d(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
      Spectrum sum;
      for (const std::uint32_t light : seen) sum += emitted_infinite(scene.lights()[light], from, d, w);
      texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = {
          sum[0], sum[1], sum[2], 1};
    }
  });
  gl::Texture texture(GL_RGBA32F, width, height, static_cast<int>(std::bit_width(static_cast<unsigned>(width))));
  texture.write({}, texels.data());
  texture.filter(GL_LINEAR_MIPMAP_LINEAR, GL_LINEAR, GL_REPEAT);
  texture.generate_mipmaps();
  return texture;
}

std::set<std::uint32_t> used_materials(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const ShapeStore* shape : shapes_of(scene))
    if (!shape->record.is_interface) used.insert(shape->record.material);
  return used;
}

bool has_moved(const std::vector<GpuDraw>& before, const std::vector<GpuDraw>& now) {
  return !std::equal(before.begin(), before.end(), now.begin(), now.end(), [](const GpuDraw& a, const GpuDraw& b) {
    return a.to_world == b.to_world && a.material == b.material && a.layer == b.layer;
  });
}

}  // namespace

void set_eye_paths(const gl::Program& program, const EyePaths& eye_paths) {
  program.set("eye_paths_looked_at", eye_paths.looked_at);
  program.set("eye_paths_wanted", eye_paths.wanted);
}

float opacity_at(const ShapeStore& shape, const Vec2& uv) {
  const TexturePoint at{.uv = uv};
  return is_cut_out(shape) ? std::clamp(shape.textures->evaluate(shape.alpha, at), 0.0f, 1.0f) : 1;
}

std::vector<const ShapeStore*> shapes_of(const Scene& scene) {
  std::vector<const ShapeStore*> shapes;
  for (const auto& shape : scene.data()->geometry->shapes()) shapes.push_back(shape.get());
  for (const auto& group : scene.data()->geometry->groups())
    for (const auto& shape : group) shapes.push_back(shape.get());
  return shapes;
}

std::vector<Vec3> environment_fingerprint(const Scene& scene) {
  constexpr int across = 16;
  std::vector<Vec3> values;
  const Wavelengths w = Wavelengths::rgb(0.5f);
  const Point centre = scene.bounding_sphere().centre;
  for (int i = 0; i < across * across; ++i) {
    const int column = i % across, row = i / across;
    const Vec2 u((static_cast<float>(column) + 0.5f) / across, (static_cast<float>(row) + 0.5f) / across);
    Spectrum sum;
    for (const std::uint32_t light : scene.infinite_lights())
      sum += emitted_infinite(scene.lights()[light], centre, sample_uniform_sphere(u), w);
    values.emplace_back(sum[0], sum[1], sum[2]);
  }
  // Suns lie between these directions.
  for (const std::uint32_t light : scene.infinite_lights())
    if (const auto sample = sample_direct(scene.lights()[light], centre, Vec2(0.5f), w)) {
      values.push_back(sample->wi);
      values.emplace_back(sample->radiance[0], sample->radiance[1], sample->radiance[2]);
    }
  return values;
}

GpuScene::GpuScene(const Scene& scene) {
  const SceneModel model = model_of(scene);
  std::vector<GpuVertex> vertices;
  std::vector<std::uint32_t> indices;
  for (const SceneMesh& mesh : model.meshes) {
    first_index_.push_back(static_cast<std::uint32_t>(indices.size()));
    base_vertex_.push_back(static_cast<std::uint32_t>(vertices.size()));
    for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
    index_count_.push_back(static_cast<std::uint32_t>(indices.size()) - first_index_.back());
    const std::vector<GpuVertex> own = vertices_of(mesh);
    vertices.insert(vertices.end(), own.begin(), own.end());
  }
  for (const ShapeStore* shape : shapes_of(scene)) slack_.push_back(slack_of(*shape));
  vertices_ = gl::Buffer(vertices);
  indices_ = gl::Buffer(indices);
  make_vertex_array();
  plastic_albedo_ = gl::Texture(GL_RG32F, gpu::plastic_cosines + 2, gpu::plastic_widths);
  plastic_albedo_.write({GL_RG, GL_FLOAT}, plastic_albedos().data());
  update(scene);
}

void GpuScene::update(const Scene& scene) {
  limitations_.clear();
  sphere_ = scene.bounding_sphere();
  const std::vector<GpuMaterial> materials = material_data_;
  const std::vector<GpuDraw> draws = draw_data_;
  std::vector<SurfaceLayer> layers;
  make_materials(scene, layers);
  make_draws(scene, layers);
  const bool are_other_textures = textures_.update(layers);
  if (surface_version_ == 0 || are_other_textures || materials != material_data_ || has_moved(draws, draw_data_))
    ++surface_version_;
  std::vector<Vec3> environment = environment_fingerprint(scene);
  if (environment_.name() == 0 || environment != environment_fingerprint_) environment_ = make_environment(scene);
  environment_fingerprint_ = std::move(environment);
}

void GpuScene::make_materials(const Scene& scene, std::vector<SurfaceLayer>& layers) {
  material_data_.assign(scene.data()->materials->table.size(), {});
  bool has_more = false;
  for (const std::uint32_t i : used_materials(scene)) {
    SurfaceMaterial surface = surface_material(scene, i);
    if (layers.size() + surface.layers.size() > most_layers) {
      has_more = true;
      const std::uint32_t traced = surface.common.flags & gpu::flag_traced;
      surface = {material_at(scene, i, Vec2(0.5f)), {}};
      surface.common.flags |= traced;
    }
    surface.common.layer = static_cast<std::uint32_t>(layers.size());
    layers.insert(layers.end(), surface.layers.begin(), surface.layers.end());
    material_data_[i] = surface.common;
  }
  if (has_more)
    limitations_.push_back(fmt::format("only {} textures are kept: some materials have one colour", most_layers));
  materials_ = gl::Buffer(material_data_);
}

void GpuScene::make_patterns(const Scene& scene, const std::vector<const ShapeStore*>& shapes,
                             std::vector<SurfaceLayer>& layers) {
  std::map<std::uint32_t, std::uint32_t> layer_of_mesh;
  bool has_more = false;
  for (GpuDraw& draw : draw_data_) {
    const ShapeStore* shape = shapes[draw.mesh];
    const std::uint32_t light = draw.first_light;
    const bool has_emission = shape->record.emits && has_picture(scene, light);
    if (shape->record.emits) draw.emission = largest_emission(scene, light);
    if (!has_emission && !is_cut_out(*shape)) continue;
    const auto found = layer_of_mesh.find(draw.mesh);
    if (found == layer_of_mesh.end() && layers.size() == most_layers) {
      has_more = true;
      continue;
    }
    draw.layer = found != layer_of_mesh.end() ? found->second : static_cast<std::uint32_t>(layers.size());
    if (found != layer_of_mesh.end()) continue;
    layer_of_mesh[draw.mesh] = draw.layer;
    layers.emplace_back([&scene, shape, has_emission, light, largest = Vec3(draw.emission)](const Vec2& uv) {
      const Vec3 emitted = has_emission ? Vec3(emission_of(scene, light, uv)) / max(largest, Vec3(1e-20f)) : Vec3(1);
      return glm::vec4(emitted, opacity_at(*shape, uv));
    });
  }
  if (has_more)
    limitations_.push_back(
        fmt::format("only {} textures are kept: some lamps have one colour, and some surfaces no holes", most_layers));
}

void GpuScene::add_draw(const GeometryRecord& record, std::size_t mesh, const Transform& to_world,
                        std::uint32_t first_light) {
  if (record.is_interface) return;
  GpuDraw draw{};
  draw.layer = gpu::no_layer;
  draw.to_world = Mat4(to_world.matrix);
  draw.normal_to_world = Mat4(glm::transpose(to_world.inverse));
  draw.material = record.material;
  draw.first_index = first_index_[mesh];
  draw.base_vertex = base_vertex_[mesh];
  const glm::mat3 linear(to_world.matrix);
  draw.slack = slack_[mesh] *
               std::sqrt(std::max({length_squared(linear[0]), length_squared(linear[1]), length_squared(linear[2])}));
  draw.index_count = index_count_[mesh];
  draw.mesh = static_cast<std::uint32_t>(mesh);
  draw.first_light = first_light;
  draw_data_.push_back(draw);
  triangles_ += index_count_[mesh] / 3;
}

void GpuScene::make_draws(const Scene& scene, std::vector<SurfaceLayer>& layers) {
  const SceneData& data = *scene.data();
  const std::vector<const ShapeStore*> shapes = shapes_of(scene);
  draw_data_.clear();
  triangles_ = 0;
  std::size_t mesh = 0;
  for (const auto& shape : data.geometry->shapes())
    add_draw(shape->record, mesh++, Transform(), shape->record.first_light);
  std::vector<std::size_t> first_of_group;
  for (const auto& group : data.geometry->groups()) {
    first_of_group.push_back(mesh);
    mesh += group.size();
  }
  const float shutter_open = data.description.view.camera.shutter_open;
  for (const PlacedInstance& p : *data.placed) {
    const Transform to_world = p.placed.outer.at(shutter_open) * p.placed.inner.at(shutter_open);
    const std::size_t first = first_of_group[p.placed.group], count = data.geometry->groups()[p.placed.group].size();
    for (std::size_t m = first; m < first + count; ++m) add_draw(shapes[m]->record, m, to_world, p.placed.first_light);
  }
  make_patterns(scene, shapes, layers);
  upload_draws(shapes);
}

void GpuScene::upload_draws(const std::vector<const ShapeStore*>& shapes) {
  std::vector<DrawCommand> commands, camera_commands;
  std::vector<std::uint32_t> numbers;
  for (const GpuDraw& draw : draw_data_) {
    const auto number = static_cast<std::uint32_t>(numbers.size());
    commands.push_back({draw.index_count, 1, draw.first_index, draw.base_vertex, number});
    if (!shapes[draw.mesh]->record.is_hidden) camera_commands.push_back(commands.back());
    numbers.push_back(number);
  }
  commands_ = gl::Buffer(commands);
  camera_commands_ = gl::Buffer(camera_commands);
  draws_ = gl::Buffer(draw_data_);
  draw_numbers_ = gl::Buffer(numbers);
  // The number of a draw is an attribute of its only instance: OpenGL 4.5 has no gl_BaseInstance.
  glVertexArrayVertexBuffer(vertex_array_.name(), 1, draw_numbers_.name(), 0, sizeof(std::uint32_t));
}

float GpuScene::largest_slack() const {
  float largest = 0;
  for (const GpuDraw& draw : draw_data_) largest = std::max(largest, draw.slack);
  return largest;
}

bool GpuScene::has_patterns() const {
  return std::any_of(draw_data_.begin(), draw_data_.end(), [](const GpuDraw& d) { return d.layer != gpu::no_layer; });
}

bool GpuScene::has_eye_paths() const {
  return std::any_of(material_data_.begin(), material_data_.end(),
                     [](const GpuMaterial& m) { return (m.flags & (gpu::flag_smooth | gpu::flag_traced)) != 0; });
}

bool GpuScene::has_stand_ins() const {
  return std::any_of(material_data_.begin(), material_data_.end(),
                     [](const GpuMaterial& m) { return (m.flags & gpu::flag_stand_in) != 0; });
}

void GpuScene::make_vertex_array() {
  vertex_array_ = gl::make_vertex_array();
  const GLuint name = vertex_array_.name();
  glVertexArrayElementBuffer(name, indices_.name());
  glVertexArrayVertexBuffer(name, 0, vertices_.name(), 0, sizeof(GpuVertex));
  for (GLuint attribute = 0; attribute < 2; ++attribute) {  // position and u; normal and v
    glEnableVertexArrayAttrib(name, attribute);
    glVertexArrayAttribFormat(name, attribute, 4, GL_FLOAT, GL_FALSE, 16 * attribute);
    glVertexArrayAttribBinding(name, attribute, 0);
  }
  glEnableVertexArrayAttrib(name, 2);
  glVertexArrayAttribIFormat(name, 2, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(name, 2, 1);
  glVertexArrayBindingDivisor(name, 1, 1);
}

void GpuScene::bind() const {
  vertices_.bind_storage(gpu::storage_vertices);
  indices_.bind_storage(gpu::storage_indices);
  draws_.bind_storage(gpu::storage_draws);
  materials_.bind_storage(gpu::storage_materials);
  textures_.bind();
  plastic_albedo_.bind(gpu::unit_plastic_albedo);
  environment_.bind(gpu::unit_environment);
}

void GpuScene::draw(const gl::Buffer& commands) const {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands.name());
  const auto count = static_cast<GLsizei>(commands.bytes() / sizeof(DrawCommand));
  glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, count, 0);
}

}  // namespace lanthorn
