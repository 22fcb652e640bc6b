// SPDX-FileCopyrightText: 2026 The Lanthorn authors
// SPDX-License-Identifier: Apache-2.0
// Time per call of each closure's f, pdf, all parts and sample, through the variant, with different directions in every
// call.
#include <benchmark/benchmark.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "math/hash.h"
#include "math/sampling.h"
#include "surface/bsdf.h"

namespace lanthorn {
namespace {

struct Query {
  Vec3 wi, wo;
  float u_lobe;
  Vec2 u;
};

std::vector<Query> queries() {
  std::vector<Query> list(4096);
  HashRng rng(1);
  for (Query& q : list) {
    q.wi = sample_cosine_hemisphere(rng.next2());
    q.wo = sample_uniform_sphere(rng.next2());
    q.u_lobe = rng.next();
    q.u = rng.next2();
  }
  return list;
}

/// Runs `call` once per iteration on the next query.
template <class Call>
void run(benchmark::State& state, Call&& call) {
  const std::vector<Query> list = queries();
  std::size_t i = 0;
  for (auto _ : state) {
    auto result = call(list[i++ % list.size()]);
    benchmark::DoNotOptimize(result);
  }
}

void register_closure(const std::string& name, const Bsdf& bsdf) {
  const auto evaluation = [&](const std::string& what, BsdfParts parts) {
    benchmark::RegisterBenchmark((what + '/' + name).c_str(), [bsdf, parts](benchmark::State& state) {
      run(state, [&](const Query& q) { return evaluate(bsdf, q.wi, q.wo, Transport::radiance, parts); });
    });
  };
  evaluation("f", {.f = true});
  evaluation("pdf", {.pdf = true});
  evaluation("f_and_pdf", {.f = true, .pdf = true});
  evaluation("all", all_parts);
  benchmark::RegisterBenchmark(("sample/" + name).c_str(), [bsdf](benchmark::State& state) {
    run(state, [&](const Query& q) { return sample(bsdf, q.wi, q.u_lobe, q.u, Transport::radiance); });
  });
}

void register_all() {
  const Conductor mirror{.eta = Spectrum(0.2f), .k = Spectrum(3.9f)};
  const Conductor metal{.eta = Spectrum(0.2f), .k = Spectrum(3.9f), .alpha_x = 0.3f, .alpha_y = 0.2f};
  const Dielectric rough{.eta = 1.5f, .alpha_x = 0.3f, .alpha_y = 0.3f};
  const Diffuse grey{Spectrum(0.5f)};
  register_closure("diffuse", grey);
  register_closure("diffuse_transmission", DiffuseTransmission{Spectrum(0.5f), Spectrum(0.3f)});
  register_closure("mirror", mirror);
  register_closure("rough_conductor", metal);
  register_closure("glass", Dielectric{});
  register_closure("rough_glass", rough);
  register_closure("thin_glass", ThinDielectric{});
  register_closure("coated_diffuse", CoatedDiffuse{.base = grey});
  register_closure("rough_coated_diffuse", CoatedDiffuse{.coat = rough, .base = grey});
  static const CoatPassage smooth_coat({}, 0.01f), rough_coat(rough, 0.01f);
  register_closure("clear_coated", ClearCoated{&smooth_coat, grey.reflectance});
  register_closure("rough_clear_coated", ClearCoated{&rough_coat, grey.reflectance});
  register_closure("coated_conductor", CoatedConductor{.base = under_coat(metal, 1.5f)});
  register_closure("rough_coated_conductor", CoatedConductor{.coat = rough, .base = under_coat(metal, 1.5f)});
  register_closure("milky_coated_diffuse",
                   CoatedDiffuse{.coat = rough, .base = grey, .thickness = 0.5f, .albedo = Spectrum(0.8f)});
}

}  // namespace
}  // namespace lanthorn

int main(int argc, char** argv) {
  lanthorn::register_all();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
