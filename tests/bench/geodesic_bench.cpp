#include "geodesic_bench.h"

#include <memory>
#include <stdexcept>

#include <mimetra/geodesic/heat_geodesics.h>
#include <mimetra/mesh/parallel.h>

#include "cgal_geodesics.h"
#include "sparse_factor.h"

namespace mimetra::bench {
namespace {

using geodesic::HeatGeodesics;

constexpr const char* kGroup = "geodesics";

std::vector<int> spread_sources(int vertices, int count) {
  std::vector<int> sources;
  sources.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) sources.push_back(i * vertices / count);
  return sources;
}

/// Distances from each source, on all threads.
std::vector<Eigen::VectorXd> own_distances(const HeatGeodesics& geodesics,
                                           const std::vector<int>& sources) {
  std::vector<Eigen::VectorXd> result(sources.size());
  parallel_for(static_cast<int>(sources.size()), 0, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    result[at] = geodesics.distances(sources[at]);
  });
  return result;
}

/// Two systems are factored.
Work setup_work(const SparseFactor& factor) {
  return {2 * factor.factor_flops, 2 * factor.bytes()};
}

/// Two systems are solved for each source; sources may share a pass over the factors.
Work query_work(const SparseFactor& factor, double vertices, double sources) {
  return {2 * sources * factor.solve_flops(), 2 * factor.bytes() + sources * vertices * 8};
}

Work both(const Work& a, const Work& b) {
  return {a.flops + b.flops, a.bytes + b.bytes};
}

/// Both are the same method: what is compared must agree.
void require_agreement(const std::vector<Eigen::VectorXd>& own,
                       const std::vector<Eigen::VectorXd>& others) {
  constexpr double kAgreement = 1e-6;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const double difference = (own[i] - others[i]).lpNorm<Eigen::Infinity>();
    if (difference <= kAgreement * others[i].lpNorm<Eigen::Infinity>()) continue;
    throw std::runtime_error("geodesic distances differ from CGAL's by " +
                             std::to_string(difference));
  }
}

}  // namespace

std::vector<Row> geodesic_rows(const Subject& subject, int source_count, bool with_cgal,
                               const Settings& settings) {
  const Positions& rest = subject.performance.rest();
  const Triangles& triangles = subject.performance.triangles();
  const int vertices = subject.performance.vertices();
  const SparseFactor factor = sparse_factor(vertices, triangles);
  const std::vector<int> sources = spread_sources(vertices, source_count);
  const HeatGeodesics geodesics(rest, triangles);
  const Size size{subject.name, 0, vertices},
      with_sources{subject.name, 0, vertices, "sources", source_count};
  const Rate each{"source", static_cast<double>(source_count)};
  const Work query = query_work(factor, vertices, source_count);
  const Work all = both(setup_work(factor), query);
  std::vector<Case> cases = {{{kGroup, kGeodesicSetup, size, setup_work(factor)},
                              [&] { const HeatGeodesics made(rest, triangles); }},
                             {{kGroup, kGeodesicQuery, with_sources, query, each},
                              [&] { own_distances(geodesics, sources); }},
                             {{kGroup, kGeodesicAll, with_sources, all, each},
                              [&] { own_distances(HeatGeodesics(rest, triangles), sources); }}};
  if (with_cgal) {
    require_agreement(own_distances(geodesics, sources), cgal_distances(rest, triangles, sources));
    cases.push_back({{kGroup, kGeodesicCgal, with_sources, all, each},
                     [&] { cgal_distances(rest, triangles, sources); }});
  }
  return measured(cases, settings.quick);
}

}  // namespace mimetra::bench
