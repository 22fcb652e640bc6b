// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "fuzz/targets.h"

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "fuzz/require.h"
#include "image/image_file.h"
#include "io/gltf/reader.h"
#include "io/measured_brdf.h"
#include "io/obj/reader.h"
#include "io/pbrt/reader.h"
#include "io/ply.h"
#include "lanthorn/error.h"
#include "render/method_of_file.h"
#include "spectrum/curve.h"
#include "surface/bsdf.h"

namespace lanthorn::fuzz {

namespace {

using namespace description;

// All existing files.
std::string file_in_memory(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  if (name == "a.pbrt") return R"(AttributeBegin Translate 1 0 0 Shape "sphere" AttributeEnd)";
  if (name == "b.pbrt") return "AttributeEnd";
  if (name == "c.pbrt") return R"(Include "a.pbrt" Include "t.pbrt")";
  if (name == "a.spd") return "400 1\n500 2 # end";
  if (name == "a.ply")
    return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
           "face 2\n"
           "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n4 0 1 2 3\n";
  if (name == "a.mtl")
    return "newmtl m\nKd 1 0 0\nmap_Kd -s 2 2 a.png\nnewmtl n\nKe 1 1 1\nd 0.5\nnewmtl o\nPm 0.5\nPr 0.1\n";
  if (name == "b.mtl") return "newmtl m\nillum 7\nNi";
  if (name == "a.bsdf") return std::string("tensor_file\0\1\0\0\0\0\0", 18);
  if (name == "a.bin") return std::string(256, '\1');
  throw Error(name + ": no such file");
}

template <class Mesh, class Faces>
void check_mesh(const Mesh& mesh, const Faces& faces) {
  const std::size_t count = mesh.positions.size();
  require(mesh.normals.empty() || mesh.normals.size() == count, "number of normals");
  require(mesh.uvs.empty() || mesh.uvs.size() == count, "number of uvs");
  for (const auto& face : faces)
    for (const std::uint32_t corner : face) {
      require(corner < count, "vertex index");
      for (int i = 0; i < 3; ++i) require(std::isfinite(mesh.positions[corner][i]), "position");
    }
}

void check_shape(const SceneDescription& scene, const Shape& shape) {
  require(shape.material < scene.materials.size(), "material of a shape");
  require(!shape.area_light || *shape.area_light < scene.area_lights.size(), "area light of a shape");
  require(!shape.alpha.texture || *shape.alpha.texture < scene.float_textures.size(), "alpha texture of a shape");
  if (const auto* mesh = std::get_if<TriangleMesh>(&shape.geometry)) check_mesh(*mesh, mesh->triangles);
  if (const auto* patches = std::get_if<BilinearMesh>(&shape.geometry)) check_mesh(*patches, patches->patches);
}

void check_scene(const SceneDescription& scene) {
  for (const Shape& shape : scene.shapes) check_shape(scene, shape);
  for (const Object& object : scene.objects)
    for (const Shape& shape : object.shapes) check_shape(scene, shape);
  for (const Instance& instance : scene.instances)
    require(instance.object < scene.objects.size(), "object of an instance");
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    if (const auto* mix = std::get_if<MixMaterial>(&scene.materials[i].node))
      require(mix->materials[0] < i && mix->materials[1] < i, "part of a mix");
  require(scene.view.film.width > 0 && scene.view.film.height > 0, "size of the film");
}

void check_lens(const RealisticCamera& camera) {
  require(!camera.elements.empty(), "elements of a lens");
  for (const LensElement& e : camera.elements) {
    require(std::isfinite(e.curvature_radius) && std::isfinite(e.eta), "glass of a lens");
    require(e.thickness >= 0 && e.aperture_diameter >= 0, "size of a lens");
  }
}

void check_spectrum(const SampledSpectrum& s) {
  require(!s.nm.empty() && s.nm.size() == s.values.size(), "samples of a spectrum");
  for (std::size_t i = 1; i < s.nm.size(); ++i) require(s.nm[i - 1] < s.nm[i], "wavelengths of a spectrum");
  for (const bool extend_ends : {false, true}) resample(s.nm.data(), s.values.data(), s.nm.size(), extend_ends);
}

// Sampled directions can be evaluated. Unbounded values may overflow, but must not be negative.
void check_samples(const Measured& closure, const Vec3& wi) {
  for (const float u : {0.0f, 0.2f, 0.5f, 0.9f}) {
    const auto drawn = sample(closure, wi, 0.5f, {u, 1 - u - 0.05f}, Transport::radiance);
    if (!drawn) continue;
    require(drawn->pdf > 0 && std::fabs(length_squared(drawn->wo) - 1) < 1e-3f, "sample of a measured BRDF");
    for (int i = 0; i < 4; ++i) require(!(drawn->weight[i] < 0), "weight of a sample of a measured BRDF");
  }
}

}  // namespace

namespace {

// The translation of a readable pbrt-v3 file is readable, too. No file contains non-finite numbers.
void check_upgrade(std::string_view text) {
  std::string upgraded;
  try {
    upgraded = pbrt::upgrade(text, "", "", "t.pbrt", file_in_memory).text;
  } catch (const Error&) {
    return;  // of pbrt-v4
  }
  if (upgraded.find("inf") == upgraded.npos && upgraded.find("nan") == upgraded.npos)
    pbrt::read(upgraded, "", "upgraded.pbrt", method_of_file, file_in_memory);
}

}  // namespace

void read_pbrt(std::string_view text) {
  try {
    check_scene(pbrt::read(text, "", "t.pbrt", method_of_file, file_in_memory));
  } catch (const Error& error) {
    require(!error.where.file.empty() && error.where.line > 0 && error.where.column > 0, error.what());
    return;
  }
  check_upgrade(text);
}

void read_tables(std::string_view text) {
  const auto read = [&](std::string_view scene) {
    try {
      return std::optional(
          pbrt::read(scene, "", "t.pbrt", method_of_file, [&](const auto&) { return std::string(text); }));
    } catch (const Error& error) {
      require(!error.where.file.empty() && error.where.line > 0 && error.where.column > 0, error.what());
      return std::optional<SceneDescription>();
    }
  };
  if (const auto scene = read(R"(Camera "realistic" "string lensfile" "t.dat" WorldBegin)"))
    check_lens(std::get<RealisticCamera>(scene->view.camera.node));
  if (const auto scene = read(R"(WorldBegin LightSource "point" "spectrum I" "t.spd")"))
    check_spectrum(std::get<SampledSpectrum>(std::get<PointLight>(scene->lights.front().node).intensity.spectrum));
}

// Choosing a view takes a hundred times as long as reading a small file: only some files get one.
void check_model(ModelFile file, std::string_view bytes) {
  check_scene(file.scene);
  if (bytes.size() % 512 == 0) check_scene(with_stand_ins(std::move(file)));
}

void read_gltf(std::string_view bytes) {
  try {
    check_model(gltf::read(bytes, "", "t.gltf", file_in_memory), bytes);
  } catch (const Error& error) {
    require(error.where.file.starts_with("t.gltf"), error.what());
  }
}

void read_obj(std::string_view text) {
  try {
    check_model(obj::read(text, "", "t.obj", file_in_memory), text);
  } catch (const Error& error) {
    require(!error.where.file.empty() && error.where.line > 0 && error.where.column > 0, error.what());
  }
}

void read_measured(std::string_view bytes) {
  try {
    const MeasuredData data = parse_measured_brdf(bytes, "t.bsdf");
    constexpr int albedo_side = 3;  // small, since filling the tables would take most of the time
    const MeasuredBrdf brdf(data, albedo_side);
    for (const Wavelengths& w : {Wavelengths::rgb(0.3f), Wavelengths::spectral(0.3f)})
      for (const Vec3& wi : {Vec3(0, 0, 1), Vec3(0.6f, 0, 0.8f), Vec3(0, -0.8f, -0.6f), Vec3(1, 0, 1e-6f)})
        check_samples(Measured{&brdf, w}, wi);
  } catch (const Error& error) {
    require(error.where.file == "t.bsdf", error.what());
  }
}

void read_hdr(std::string_view bytes) {
  if (!bytes.starts_with("#?")) return;
  try {
    constexpr std::uint64_t most_pixels = 1 << 16;
    ImageFile file(bytes, "image", {"t.hdr"}, most_pixels);
    const ImageHeader& header = file.header();
    require(header.channels.size() == 3 && header.samples == SampleType::float32, "channels");
    std::vector<float> pixels(3 * static_cast<std::size_t>(header.width) * static_cast<std::size_t>(header.height), -1);
    file.read(3, pixels.data());
    for (const float value : pixels) require(value >= 0 && std::isfinite(value), "pixel");
  } catch (const Error& error) {
    require(error.where.file == "t.hdr", error.what());
  }
}

void read_ply(std::string_view bytes) {
  try {
    const PlyMesh mesh = parse_ply(bytes, "t.ply");
    check_mesh(mesh.triangles, mesh.triangles.triangles);
    check_mesh(mesh.quads, mesh.quads.patches);
  } catch (const Error& error) {
    require(error.where.file == "t.ply", error.what());
  }
}

}  // namespace lanthorn::fuzz
