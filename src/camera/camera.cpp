// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// References:
// Pharr, Jakob, Humphreys 2023, "Physically Based Rendering" 4e, ch. 5 (rays of film positions).
//   Kolb, Mitchell, Hanrahan 1995, "A Realistic Camera Model for Computer Graphics".
//   Veach 1997, §8.3 and §10.3 (importance of a lens, its sampling from the scene).
#include "camera/camera.h"

#include <algorithm>
#include <cmath>

#include "math/octahedral.h"
#include "math/sampling.h"

namespace lanthorn {

namespace {

constexpr double double_pi = std::numbers::pi;

double cube(double x) { return x * x * x; }

// Panoramas in both layouts have y up; the mappings have z up.
DVec3 swap_yz(const DVec3& v) { return {v.x, v.z, v.y}; }

// World-space area per unit area of the orthographic film plane.
double film_area(const Affine& to_world) { return glm::length(glm::cross(to_world.linear[0], to_world.linear[1])); }

}  // namespace

AnimatedTransform framing(const description::Camera& camera, int width, int height) {
  const auto* perspective = std::get_if<description::PerspectiveCamera>(&camera.node);
  if (!camera.subject || perspective == nullptr) return camera.camera_to_world;
  const float aspect = static_cast<float>(width) / static_cast<float>(std::max(height, 1));
  constexpr float margin = 1.05f;
  const Point centre = camera.subject->centre();
  const Vec3 half = 0.5f * camera.subject->extent();
  const float tangent = std::tan(to_radians(perspective->fov / 2)) / margin;
  const float distance =
      half.z + std::max(half.x / (tangent * std::max(aspect, 1.0f)), half.y / (tangent * std::max(1 / aspect, 1.0f)));
  const Transform move = translate({centre.x, centre.y, centre.z - (distance > 0 ? distance : 1)});  // 1 for a point
  const AnimatedTransform& to_world = camera.camera_to_world;
  return {to_world.start * move, to_world.end * move, to_world.start_time, to_world.end_time};
}

Camera::Camera(const description::Camera& camera, int width, int height, const Vec2& margin)
    : to_world_(framing(camera, width, height)),
      shutter_open_(camera.shutter_open),
      shutter_close_(std::max(camera.shutter_open, camera.shutter_close)),
      margin_(margin),
      width_(width),
      height_(height) {
  if (width < 1 || height < 1) throw Error(camera.location, "the film has no pixels");
  if (camera.camera_to_world.start.is_singular() || camera.camera_to_world.end.is_singular())
    throw Error(camera.location, "the camera's transformation is singular");
  const double aspect = camera.frame_aspect_ratio.value_or(static_cast<float>(width) / static_cast<float>(height));
  glm::dvec2 low(-std::max(aspect, 1.0), -std::max(1 / aspect, 1.0));
  glm::dvec2 high = -low;
  if (camera.screen_window) {
    const auto& [x0, x1, y0, y1] = *camera.screen_window;
    low = {x0, y0};
    high = {x1, y1};
  }
  double scale = 1;
  if (const auto* perspective = std::get_if<description::PerspectiveCamera>(&camera.node)) {
    kind_ = Kind::perspective;
    if (!(perspective->fov > 0 && perspective->fov < 180))
      throw Error(camera.location, "the field of view must lie between 0 and 180 degrees");
    scale = std::tan(static_cast<double>(perspective->fov) * double_pi / 360);
    lens_radius_ = perspective->lens_radius;
    focal_distance_ = perspective->focal_distance;
  } else if (const auto* orthographic = std::get_if<description::OrthographicCamera>(&camera.node)) {
    kind_ = Kind::orthographic;
    lens_radius_ = orthographic->lens_radius;
    focal_distance_ = orthographic->focal_distance;
  } else if (const auto* realistic = std::get_if<description::RealisticCamera>(&camera.node)) {
    kind_ = Kind::realistic;
    const double ratio = static_cast<double>(height) / width;
    const double across = static_cast<double>(realistic->film_diagonal) / std::sqrt(1 + ratio * ratio);
    low = {-0.5 * across, -0.5 * across * ratio};
    high = -low;
    if (!(across > 0)) throw Error(camera.location, "the film of a realistic camera needs a diagonal above 0");
    const glm::dvec2 pixel = (high - low) / glm::dvec2(width, height);
    lens_ = LensSystem(*realistic, glm::length(high + pixel * glm::dvec2(margin)), camera.location);
  } else {
    const auto& spherical = std::get<description::SphericalCamera>(camera.node);
    kind_ = spherical.mapping == description::SphericalMapping::equal_area ? Kind::equal_area : Kind::equirectangular;
  }
  if (lens_radius_ < 0 || (lens_radius_ > 0 && !(focal_distance_ > 0)))
    throw Error(camera.location, "a lens needs a radius and a focal distance that are positive");
  screen_min_ = low * scale;
  screen_size_ = (high - low) * scale;
  if (screen_size_.x == 0 || screen_size_.y == 0) throw Error(camera.location, "the screen window is empty");
  screen_corner_ = {screen_min_.x, screen_min_.y + screen_size_.y};
  pixel_step_ = screen_size_ / glm::dvec2(width, -height);
}

glm::dvec2 Camera::screen(const Vec2& raster) const { return screen_corner_ + pixel_step_ * glm::dvec2(raster); }

Vec2 Camera::raster(const glm::dvec2& screen) const {
  const glm::dvec2 fraction = (screen - screen_min_) / screen_size_;
  return {static_cast<float>(fraction.x * width_), static_cast<float>((1 - fraction.y) * height_)};
}

glm::dvec2 Camera::lens_point(const Vec2& u_lens) const {
  return lens_radius_ > 0 ? lens_radius_ * glm::dvec2(sample_concentric_disk(u_lens)) : glm::dvec2(0.0);
}

bool Camera::sees(const Vec2& raster) const {
  return raster.x >= -margin_.x && raster.y >= -margin_.y && raster.x < static_cast<float>(width_) + margin_.x &&
         raster.y < static_cast<float>(height_) + margin_.y;
}

DVec3 Camera::spherical_direction(const Vec2& raster) const {
  const Vec2 uv(raster.x / static_cast<float>(width_), raster.y / static_cast<float>(height_));
  if (kind_ == Kind::equal_area) return swap_yz(DVec3(direction_from_octahedral(glm::clamp(uv, 0.0f, 1.0f))));
  const double theta = double_pi * uv.y;
  const double phi = 2 * double_pi * uv.x;
  return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

Camera::LocalRay Camera::local_ray(const Vec2& raster, const Vec2& u_lens) const {
  if (kind_ == Kind::equal_area || kind_ == Kind::equirectangular) return {DVec3(0.0), spherical_direction(raster)};
  const DVec3 through(screen(raster), 1);
  const DVec3 centre = kind_ == Kind::orthographic ? DVec3(through.x, through.y, 0) : DVec3(0.0);
  const DVec3 axis = kind_ == Kind::orthographic ? DVec3(0, 0, 1) : through;
  if (!(lens_radius_ > 0)) return {centre, axis};
  const DVec3 on_lens(lens_point(u_lens), 0);
  return {centre + on_lens, focal_distance_ * axis - on_lens};
}

// The image on the film is inverted.
Camera::WeightedRay Camera::through_lens(const Vec2& raster, const Vec2& u_lens) const {
  const DVec3 film(-screen(raster), 0);
  const double distance = glm::length(film);
  const LensSystem::Pupil& pupil = lens_.exit_pupil(distance);
  const glm::dvec2 p = pupil.low + glm::dvec2(u_lens) * (pupil.high - pupil.low);
  const double cos_turn = distance > 0 ? film.x / distance : 1, sin_turn = distance > 0 ? film.y / distance : 0;
  const DVec3 at_pupil(cos_turn * p.x - sin_turn * p.y, sin_turn * p.x + cos_turn * p.y, lens_.rear_z());
  const DVec3 direction = glm::normalize(at_pupil - film);
  const std::optional<LensRay> out = lens_.towards_scene({film, direction});
  if (!out) return {{film, direction}, 0};
  return {{out->origin, out->direction}, sqr(sqr(direction.z)) * pupil.area() / sqr(lens_.rear_z())};
}

CameraRay Camera::sample_ray(const Vec2& raster, const Vec2& u_lens, float time) const {
  const auto [local, weight] =
      kind_ == Kind::realistic ? through_lens(raster, u_lens) : WeightedRay{local_ray(raster, u_lens), 1};
  std::optional<Affine> moved;
  const Affine& map = to_world_.at(time, moved);
  CameraRay result;
  result.weight = static_cast<float>(weight);
  result.ray.origin = Point(map.point(local.origin));
  result.ray.direction = Vec3(glm::normalize(map.vector(local.direction)));
  result.ray.time = time;
  set_footprint(local.direction, result.ray);
  return result;
}

// Sets the footprint of a pixel for one lens point: the shorter of its extents. Realistic cameras have none.
void Camera::set_footprint(const DVec3& direction, Ray& ray) const {
  const double pixel = std::fmin(std::fabs(pixel_step_.x), std::fabs(pixel_step_.y));
  switch (kind_) {
    case Kind::perspective:
      ray.spread = static_cast<float>(pixel * sqr(direction.z) / glm::dot(direction, direction));
      break;
    case Kind::orthographic:
      ray.width = static_cast<float>(pixel);
      break;
    case Kind::equirectangular:
      ray.spread = static_cast<float>(
          std::fmin(double_pi / height_, 2 * double_pi / width_ * std::hypot(direction.x, direction.z)));
      break;
    case Kind::equal_area:  // its pixels are squares on average, and at most twice as long as wide
      ray.spread = static_cast<float>(0.7 * std::sqrt(4 * double_pi / (1.0 * width_ * height_)));
      break;
    case Kind::realistic:
      break;
  }
}

// Density per solid angle of directions at this angle to the axis, for film positions uniform over the whole film. The
// screen of area A at z = 1 subtends dw = cos^3 dA. For a thin lens the same holds at its plane of focus.
double Camera::direction_density(double cos) const {
  return 1 / (std::fabs(screen_size_.x * screen_size_.y) * cube(cos));
}

std::optional<Camera::Sight> Camera::sight_through_plane(const DVec3& local, const Vec2& u_lens) const {
  if (!(local.z > 0)) return {};
  const glm::dvec2 lens = lens_point(u_lens);
  const glm::dvec2 across(local.x, local.y);
  Sight s;
  if (kind_ == Kind::orthographic) {
    // The ray through the point at lens offset `lens` from the ray's lens centre c passes c + lens (1 - z / f).
    const double beyond = lens_radius_ > 0 ? 1 - local.z / focal_distance_ : 0;
    const glm::dvec2 centre = across - lens * beyond;
    s.lens = DVec3(centre + lens, 0);
    s.raster = raster(centre);
    const double cos = glm::normalize(local - s.lens).z;
    s.density = 1 / (std::fabs(screen_size_.x * screen_size_.y) * cos);
  } else {
    s.lens = DVec3(lens, 0);
    const glm::dvec2 at_focus =
        lens_radius_ > 0 ? lens / focal_distance_ + (across - lens) / local.z : across / local.z;
    s.raster = raster(at_focus);
    s.density = direction_density(glm::normalize(local - s.lens).z);
  }
  return s;
}

std::optional<Camera::FilmHit> Camera::film_hit(const LensRay& from_scene) const {
  const std::optional<LensRay> rear = lens_.towards_film(from_scene);
  if (!rear) return {};
  const DVec3 film = rear->origin - rear->direction * (rear->origin.z / rear->direction.z);
  return FilmHit{glm::dvec2(film), rear->direction};
}

// Flux through the lens's front that reaches the film on any path inside the lens, so that no density of the internal
// path is needed.
std::optional<Camera::Sight> Camera::sight_through_lens(const DVec3& local, const Vec2& u_lens) const {
  const double radius = lens_.front_radius();
  const LensSystem::FrontPoint front = lens_.front_point(radius * glm::dvec2(sample_concentric_disk(u_lens)));
  const DVec3 way = front.position - local;
  const double facing = -glm::dot(glm::normalize(way), front.normal);
  // A ray that hits the front surface from behind has already crossed it: it belongs to another front point.
  if (!(facing > 0)) return {};
  const std::optional<FilmHit> hit = film_hit({local, way});
  if (!hit) return {};
  Sight s;
  s.lens = front.position;
  s.raster = raster(-hit->film);
  s.density = double_pi * radius * radius * facing / front.normal.z / std::fabs(screen_size_.x * screen_size_.y);
  return s;
}

std::optional<Camera::Sight> Camera::sight(const DVec3& local, const Vec2& u_lens) const {
  if (kind_ == Kind::realistic) return sight_through_lens(local, u_lens);
  if (kind_ == Kind::perspective || kind_ == Kind::orthographic) return sight_through_plane(local, u_lens);
  const double length = glm::length(local);
  if (!(length > 0)) return {};
  const DVec3 d = swap_yz(local / length);
  Sight s;
  Vec2 uv;
  if (kind_ == Kind::equal_area) {
    uv = octahedral_from_direction(Direction(d));
    s.density = 1 / (4 * double_pi);
  } else {
    const double sin = std::hypot(d.x, d.y);
    if (sin == 0) return {};
    const double phi = std::atan2(d.y, d.x);
    uv = {static_cast<float>((phi < 0 ? phi + 2 * double_pi : phi) / (2 * double_pi)),
          static_cast<float>(std::atan2(sin, d.z) / double_pi)};
    s.density = 1 / (2 * double_pi * double_pi * sin);
  }
  s.raster = {uv.x * static_cast<float>(width_), uv.y * static_cast<float>(height_)};
  return s;
}

std::optional<CameraConnection> Camera::connect(const Point& p, const Vec2& u_lens, float time) const {
  std::optional<CameraConnection> result;
  std::optional<Affine> moved;
  const Affine& map = to_world_.at(time, moved);
  const std::optional<Sight> s = sight(map.inverse_point(DVec3(p)), u_lens);
  if (!s || !sees(s->raster)) return result;
  const DVec3 lens = map.point(s->lens);
  const DVec3 way = lens - DVec3(p);
  const double distance2 = glm::dot(way, way);
  if (!(distance2 > 0)) return result;
  CameraConnection& c = result.emplace();
  c.raster = s->raster;
  c.lens_point = Point(lens);
  c.distance = static_cast<float>(std::sqrt(distance2));
  c.towards = normalize(Vec3(way / std::sqrt(distance2)));
  const double pixels = static_cast<double>(width_) * height_;
  c.importance = static_cast<float>(pixels * s->density / (kind_ == Kind::orthographic ? film_area(map) : distance2));
  return result;
}

std::optional<Point> Camera::lens_point_for(const Point& p, const Vec2& u_lens, float time) const {
  std::optional<Affine> moved;
  const Affine& map = to_world_.at(time, moved);
  const std::optional<Sight> s = sight(map.inverse_point(DVec3(p)), u_lens);
  return s ? std::optional(Point(map.point(s->lens))) : std::nullopt;
}

// Etendue is conserved: a ray's density per area and projected solid angle is the same in front of and behind the lens.
CameraPdf Camera::lens_pdf(const DVec3& origin, const DVec3& direction) const {
  // Rays from sample_ray start on the front surface; moved slightly forward, they hit it again.
  const LensRay from_scene{origin + 1e-3 * lens_.front_radius() * direction, -direction};
  const std::optional<FilmHit> hit = film_hit(from_scene);
  if (!hit || !sees(raster(-hit->film))) return {};
  const double cos = std::fabs(hit->from_pupil.z);
  const double on_film = 1 / std::fabs(screen_size_.x * screen_size_.y);
  const double at_pupil = 1 / lens_.exit_pupil(glm::length(hit->film)).area();
  const double position = 1 / (double_pi * sqr(lens_.front_radius()));
  const double joint = on_film * at_pupil * sqr(lens_.rear_z()) / sqr(sqr(cos));
  return {static_cast<float>(position), static_cast<float>(joint * std::fabs(direction.z) / position)};
}

CameraPdf Camera::pdf(const Ray& ray) const {
  std::optional<Affine> moved;
  const Affine& map = to_world_.at(ray.time, moved);
  if (kind_ == Kind::realistic)
    return lens_pdf(map.inverse_point(DVec3(ray.origin)), glm::normalize(map.inverse_vector(DVec3(ray.direction))));
  const DVec3 d = glm::normalize(map.inverse_vector(DVec3(ray.direction)));
  if (kind_ == Kind::equal_area) return {1, static_cast<float>(1 / (4 * double_pi))};
  if (kind_ == Kind::equirectangular) {
    const double sin = std::hypot(d.x, d.z);
    return {1, static_cast<float>(1 / (2 * double_pi * double_pi * std::max(sin, 1e-6)))};
  }
  if (!(d.z > 0)) return {};
  const double lens_area = double_pi * lens_radius_ * lens_radius_;
  if (kind_ == Kind::perspective)
    return {lens_radius_ > 0 ? static_cast<float>(1 / lens_area) : 1.0f, static_cast<float>(direction_density(d.z))};
  const double position = 1 / (std::fabs(screen_size_.x * screen_size_.y) * film_area(map));
  const double direction = lens_radius_ > 0 ? focal_distance_ * focal_distance_ / (lens_area * cube(d.z)) : 1;
  return {static_cast<float>(position), static_cast<float>(direction)};
}

float Camera::time(float u) const { return lerp(u, shutter_open_, shutter_close_); }

float Camera::density_at(const Ray& ray, float distance) const {
  const float pixels = static_cast<float>(width_) * static_cast<float>(height_);
  if (kind_ != Kind::orthographic) return pixels * pdf(ray).direction / (distance * distance);
  // For a fixed lens sample all rays are parallel.
  std::optional<Affine> moved;
  const Affine& map = to_world_.at(ray.time, moved);
  const double cos = glm::normalize(map.inverse_vector(DVec3(ray.direction))).z;
  if (!(cos > 0)) return 0;
  return pixels / static_cast<float>(std::fabs(screen_size_.x * screen_size_.y) * film_area(map) * cos);
}

}  // namespace lanthorn
