// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
#include "index/beam_bvh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "index/leaf_tree.h"
#include "index/slot_points.h"
#include "math/frame.h"

namespace lanthorn {

namespace {

constexpr std::size_t beams_per_chunk = 1u << 15, cells_per_chunk = 1u << 4;

// Reach of a beam from a point of it that was computed in single precision.
float reach_of(const Beam& beam) {
  return safe_reach(beam.radius) + 0x1p-22f * (sum_of_sizes(beam.origin) + beam.length);
}

Bounds grown(const Bounds& box, float reach) { return {box.min - Vec3(reach), box.max + Vec3(reach)}; }

// Interleaves the five lowest bits of three numbers: neighbours get similar codes (Morton 1966).
std::uint32_t morton_code(const glm::ivec3& cell) {
  std::uint32_t code = 0;
  for (int bit = 0; bit < 5; ++bit)
    for (int axis = 0; axis < 3; ++axis)
      code |= (static_cast<std::uint32_t>(cell[axis]) >> bit & 1u) << (3 * bit + axis);
  return code;
}

// Cubic cells at whose faces beams are cut.
struct Grid {
  static constexpr int most = 32;  // per axis
  Point corner{0};
  float per_metre = 0;  // cells
  glm::ivec3 last{0};

  std::size_t codes() const { return morton_code(last) + 1; }
  glm::ivec3 cell_at(const Point& p) const {
    const Vec3 place = per_metre * (p - corner);
    return glm::clamp(glm::ivec3(place), glm::ivec3(0), last);
  }
};

// A grid whose cells cut beams into `pieces_per_beam` pieces on average: a beam crosses a face for each cell that it
// advances along each axis. Cells are not small compared to radii, since that would not tighten bounds.
Grid grid_for(std::span<const Beam> beams) {
  constexpr double pieces_per_beam = 7;
  struct Sums {
    Bounds box;
    double advance = 0;
    float radius = 0;
  };
  std::vector<Sums> sums((beams.size() + beams_per_chunk - 1) / beams_per_chunk);
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    Sums sum;
    for (const Beam& beam : beams.subspan(begin, end - begin)) {
      const Vec3 way = beam.length * beam.direction;
      sum.box.extend(beam.origin);
      sum.box.extend(beam.origin + way);
      sum.advance += static_cast<double>(sum_of_sizes(way));
      sum.radius = std::max(sum.radius, beam.radius);
    }
    sums[c] = sum;
  });
  Sums all;
  for (const Sums& sum : sums) {
    all.box.extend(sum.box);
    all.advance += sum.advance;
    all.radius = std::max(all.radius, sum.radius);
  }
  const Vec3 extent = all.box.max - all.box.min;
  const float largest = std::max({extent.x, extent.y, extent.z});
  const auto wanted = static_cast<float>(all.advance / ((pieces_per_beam - 1) * static_cast<double>(beams.size())));
  const float size = std::max({wanted, 8 * all.radius, largest / (Grid::most - 0.5f)});
  if (!(size > 0 && size < infinity)) return {all.box.min};
  return {all.box.min, 1 / size, glm::ivec3(extent / size)};
}

// Calls `visit(begin, end, code)` for each piece of a beam: its points from begin to end (m; the last end is infinite),
// and the code of its cell (Amanatides & Woo 1987). Pieces that are short relative to cells are merged with the next
// one.
template <class Visit>
void cut(const Beam& beam, const Grid& grid, Visit&& visit) {
  constexpr float shortest = 0.2f;
  const Vec3 place = grid.per_metre * (beam.origin - grid.corner), speed = grid.per_metre * beam.direction;
  glm::ivec3 cell = grid.cell_at(beam.origin);
  Vec3 next, period;
  for (int axis = 0; axis < 3; ++axis) {
    const float to_face = static_cast<float>(cell[axis] + (speed[axis] > 0)) - place[axis];
    next[axis] = speed[axis] != 0 ? to_face / speed[axis] : infinity;
    period[axis] = speed[axis] != 0 ? std::fabs(1 / speed[axis]) : infinity;
  }
  float begin = 0;
  for (;;) {
    const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
    const float end = next[axis];
    const int to = cell[axis] + (speed[axis] > 0 ? 1 : -1);
    if (!(end < beam.length) || to < 0 || to > grid.last[axis]) break;
    if ((end - begin) * grid.per_metre > shortest) {
      visit(begin, end, morton_code(cell));
      begin = end;
    }
    cell[axis] = to;
    next[axis] += period[axis];
  }
  visit(begin, infinity, morton_code(cell));
}

// Counting sort by code, in two passes over chunks of items: counts per code, then positions.
class CountingSort {
 public:
  CountingSort(std::size_t things, std::size_t codes)
      : codes_(codes), counts_((things + beams_per_chunk - 1) / beams_per_chunk * codes) {}

  /// Counts of a chunk, by code.
  std::span<std::uint32_t> chunk(std::size_t c) { return std::span(counts_).subspan(c * codes_, codes_); }

  struct Range {
    std::uint32_t begin = 0, end = 0;
  };
  /// Turns counts into positions, with each code starting at a multiple of `unit`. Returns the range of each code.
  std::vector<Range> place(std::uint32_t unit) {
    std::vector<Range> ranges(codes_);
    std::uint32_t at = 0;
    for (std::size_t code = 0; code < codes_; ++code) {
      at = (at + unit - 1) / unit * unit;
      ranges[code].begin = at;
      for (std::size_t i = code; i < counts_.size(); i += codes_) at += std::exchange(counts_[i], at);
      ranges[code].end = at;
    }
    return ranges;
  }

 private:
  std::size_t codes_;
  std::vector<std::uint32_t> counts_;  ///< chunk by chunk
};

// The order of beams by the cells of their midpoints.
std::vector<std::uint32_t> sorted(std::span<const Beam> beams, const Grid& grid) {
  CountingSort sort(beams.size(), grid.codes());
  const auto code_of = [&](const Beam& beam) {
    return morton_code(grid.cell_at(beam.origin + 0.5f * beam.length * beam.direction));
  };
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    const std::span<std::uint32_t> counts = sort.chunk(c);
    for (std::size_t i = begin; i < end; ++i) ++counts[code_of(beams[i])];
  });
  sort.place(1);
  std::vector<std::uint32_t> order(beams.size());
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
    const std::span<std::uint32_t> places = sort.chunk(c);
    for (std::size_t i = begin; i < end; ++i) order[places[code_of(beams[i])]++] = static_cast<std::uint32_t>(i);
  });
  return order;
}

// A piece with its ends as the sort key within its cell.
struct alignas(16) PieceEnds {
  std::array<float, 6> key;
  std::uint32_t number;

  Point first() const { return {key[0], key[1], key[2]}; }
  Point last() const { return {key[3], key[4], key[5]}; }
};

// Orients all pieces upwards, since their direction does not matter.
PieceEnds ends_of(const Beam& beam, float begin, float end, std::uint32_t number) {
  Point a = beam.origin + begin * beam.direction, b = beam.origin + std::min(end, beam.length) * beam.direction;
  if (beam.direction.y < 0) std::swap(a, b);
  return {{a.x, a.y, a.z, b.x, b.y, b.z}, number};
}

}  // namespace

BeamBvh::Node::Node(std::span<const Hull> children, std::size_t first_child, bool of_leaves)
    : start(children, [](const Hull& child) { return child.start; }),
      end(children, [](const Hull& child) { return child.end; }),
      first(static_cast<std::uint32_t>(first_child)),
      count(static_cast<std::uint16_t>(children.size())),
      has_leaves(of_leaves) {}

BeamBvh::LaneRay::LaneRay(const RaySegment& ray)
    : origin(ray.origin),
      u{0.0f, 0.0f, 0.0f},
      v{0.0f, 0.0f, 0.0f},
      w{ray.direction.x, ray.direction.y, ray.direction.z},
      begin(ray.begin),
      end(ray.end),
      slack(rounding_at(ray.origin)) {
  const Frame frame(ray.direction);
  u = {frame.s.x, frame.s.y, frame.s.z};
  v = {frame.t.x, frame.t.y, frame.t.z};
}

// Builds an index of beams: pieces sorted by cell, a tree for each cell, and an octree of the cells.
class BeamBvh::Builder {
 public:
  Builder(BeamBvh& index, const Grid& grid) : index_(index), grid_(grid) {}

  /// Builds the index from its beams.
  void build() {
    cut_up();
    std::vector<Cell> cells = cells_with_pieces();
    const std::size_t inner = cells.back().first_node + inner_nodes(cells.back().leaves());
    index_.leaves_.resize(index_.pieces_.size() / Lanes::width);
    index_.nodes_.reserve(inner + 2 * cells.size());
    index_.nodes_.resize(inner + cells.size());
    parallel_chunks(cells.size(), cells_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      Scratch scratch;
      for (std::size_t i = begin; i < end; ++i) index_.nodes_[inner + i] = root_of(cells[i], scratch);
    });
    add_octree(std::move(cells));
  }

 private:
  struct Cell {
    std::uint32_t code;
    CountingSort::Range pieces;
    std::size_t first_node = 0;  ///< of the nodes below its root
    Hull hull{};

    std::size_t leaves() const { return leaves_for(pieces.end - pieces.begin); }
  };

  // Memory reused from cell to cell.
  struct Scratch {
    std::vector<Piece> unsorted;
    std::vector<PieceEnds> ends;
    std::vector<Hull> hulls;
  };

  static std::size_t leaves_for(std::size_t pieces) { return (pieces + Lanes::width - 1) / Lanes::width; }
  // Number of nodes below the root of a tree.
  static std::size_t inner_nodes(std::size_t leaves) {
    std::size_t sum = 0;
    for (std::size_t nodes = leaves_for(leaves); nodes > 1; nodes = leaves_for(nodes)) sum += nodes;
    return sum;
  }

  // Cuts up the beams and sorts the pieces by cell. Cells do not share leaves.
  void cut_up() {
    const std::span<const Beam> beams = index_.beams_;
    CountingSort sort(beams.size(), grid_.codes());
    parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
      const std::span<std::uint32_t> counts = sort.chunk(c);
      for (std::size_t i = begin; i < end; ++i)
        cut(beams[i], grid_, [&](float, float, std::uint32_t code) { ++counts[code]; });
    });
    ranges_ = sort.place(Lanes::width);
    index_.pieces_.resize(leaves_for(ranges_.back().end) * Lanes::width);
    parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t c, std::size_t begin, std::size_t end) {
      const std::span<std::uint32_t> places = sort.chunk(c);
      for (std::size_t i = begin; i < end; ++i)
        cut(beams[i], grid_, [&](float from, float to, std::uint32_t code) {
          index_.pieces_[places[code]++] = {static_cast<std::uint32_t>(i), from, to};
        });
    });
  }

  std::vector<Cell> cells_with_pieces() const {
    std::vector<Cell> cells;
    std::size_t nodes = 0;
    for (std::uint32_t code = 0; code < ranges_.size(); ++code) {
      if (ranges_[code].begin == ranges_[code].end) continue;
      cells.push_back({code, ranges_[code], nodes});
      nodes += inner_nodes(cells.back().leaves());
    }
    return cells;
  }

  // Sorts the pieces of a cell into leaves, and makes the cell's hull and the nodes below its root; returns the root.
  Node root_of(Cell& cell, Scratch& scratch) {
    const std::span<Piece> pieces =
        std::span(index_.pieces_).subspan(cell.pieces.begin, cell.pieces.end - cell.pieces.begin);
    auto& [unsorted, ends, hulls] = scratch;
    unsorted.assign(pieces.begin(), pieces.end());
    ends.resize(pieces.size());
    for (std::uint32_t i = 0; i < pieces.size(); ++i)
      ends[i] = ends_of(index_.beams_[pieces[i].slot], pieces[i].begin, pieces[i].end, i);
    sort_into_leaves(std::span(ends));
    for (std::size_t i = 0; i < pieces.size(); ++i) pieces[i] = unsorted[ends[i].number];

    hulls.resize(cell.leaves());
    std::size_t first = cell.pieces.begin / Lanes::width, next = cell.first_node;
    for (std::size_t i = 0; i < hulls.size(); ++i) hulls[i] = make_leaf(first + i, group(std::span(ends), i));
    bool of_leaves = true;
    while (hulls.size() > Lanes::width) {
      const std::size_t nodes = leaves_for(hulls.size());
      for (std::size_t i = 0; i < nodes; ++i) {
        const std::span<const Hull> children = group(std::span<const Hull>(hulls), i);
        index_.nodes_[next + i] = Node(children, first + i * Lanes::width, of_leaves);
        hulls[i] = union_of(children);
      }
      first = std::exchange(next, next + nodes);
      hulls.resize(nodes);
      of_leaves = false;
    }
    cell.hull = union_of(hulls);
    return Node(hulls, first, of_leaves);
  }

  // Makes a leaf of at most eight pieces.
  Hull make_leaf(std::size_t number, std::span<const PieceEnds> pieces) {
    float reach = 0;
    Hull hull;
    for (std::size_t lane = 0; lane < pieces.size(); ++lane) {
      reach = std::max(reach, reach_of(index_.beams_[index_.pieces_[number * Lanes::width + lane].slot]));
      hull.start.extend(pieces[lane].first());
      hull.end.extend(pieces[lane].last());
    }
    Bounds both = hull.start;
    both.extend(hull.end);
    Leaf& leaf = index_.leaves_[number];
    leaf.pieces = LatticeSegments(both);
    // Lanes without a piece duplicate the last one.
    for (std::size_t lane = 0; lane < Lanes::width; ++lane) {
      const PieceEnds& piece = pieces[std::min(lane, pieces.size() - 1)];
      leaf.pieces.set(lane, piece.first(), piece.last());
    }
    leaf.reach = reach + leaf.pieces.error();
    return {grown(hull.start, reach), grown(hull.end, reach)};
  }

  // Builds the levels up to the root. The roots of the cells are the last nodes.
  void add_octree(std::vector<Cell> cells) {
    while (cells.size() > 1) {
      const std::size_t first = index_.nodes_.size() - cells.size();
      std::vector<Cell> parents;
      std::vector<Node> nodes;
      for (std::size_t begin = 0, end = 0; begin < cells.size(); begin = end) {
        std::vector<Hull> children;
        for (; end < cells.size() && cells[end].code >> 3 == cells[begin].code >> 3; ++end)
          children.push_back(cells[end].hull);
        nodes.emplace_back(children, first + begin, false);
        parents.push_back({cells[begin].code >> 3, {}, 0, union_of(children)});
      }
      index_.nodes_.insert(index_.nodes_.end(), nodes.begin(), nodes.end());
      cells = std::move(parents);
    }
  }

  template <class T>
  static std::span<T> group(std::span<T> all, std::size_t i) {
    const std::span<T> rest = all.subspan(i * Lanes::width);
    return rest.first(std::min<std::size_t>(Lanes::width, rest.size()));
  }
  static Hull union_of(std::span<const Hull> hulls) {
    Hull all;
    for (const Hull& hull : hulls) all.extend(hull);
    return all;
  }

  BeamBvh& index_;
  const Grid& grid_;
  std::vector<CountingSort::Range> ranges_;  ///< of the pieces of each code
};

IndexBuild<BeamBvh> BeamBvh::build(std::span<const Beam> beams) {
  if (beams.empty()) return {};
  const Grid grid = grid_for(beams);
  std::vector<std::uint32_t> order = sorted(beams, grid);
  BeamBvh index;
  index.beams_.resize(beams.size());
  parallel_chunks(beams.size(), beams_per_chunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) index.beams_[i] = beams[order[i]];
  });
  Builder(index, grid).build();
  return {std::move(index), std::move(order)};
}

}  // namespace lanthorn
