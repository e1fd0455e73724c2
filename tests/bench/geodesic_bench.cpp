#include "tests/bench/geodesic_bench.h"

#include <algorithm>
#include <span>
#include <stdexcept>

#include "geodesic/cgal_geodesics.h"
#include "geodesic/heat_geodesics.h"
#include "tests/bench/factor_size.h"
#include "toolkit/mesh/parallel.h"

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

/// Distances from each source, on all threads: of one group of sources a matrix.
std::vector<Eigen::MatrixXd> own_distances(const HeatGeodesics& geodesics,
                                           const std::vector<int>& sources) {
  constexpr int kGroupSize = HeatGeodesics::kGroup;
  const auto count = static_cast<int>(sources.size());
  std::vector<Eigen::MatrixXd> result((count + kGroupSize - 1) / kGroupSize);
  const auto compute = [&](int i) {
    const int first = i * kGroupSize;
    result[i] = geodesics.distances_from_each(
        std::span(sources).subspan(first, std::min(kGroupSize, count - first)));
  };
  parallel_for(static_cast<int>(result.size()), compute);
  return result;
}

/// The same by CGAL's own heat method, set up here, one query after the other.
std::vector<Eigen::VectorXd> cgal_distances(const Positions& positions, const Triangles& triangles,
                                            const std::vector<int>& sources) {
  const geodesic::CgalGeodesics method(positions, triangles);
  std::vector<Eigen::VectorXd> result;
  result.reserve(sources.size());
  for (const int source : sources) result.push_back(method.distances(source));
  return result;
}

/// Two systems are factored.
Work setup_work(const FactorSize& factor) {
  return {2 * factor.factor_flops, 2 * factor.bytes()};
}

/// Two systems are solved for each source; sources may share a pass over the factors.
Work query_work(const FactorSize& factor, double vertices, double sources) {
  return {2 * sources * factor.solve_flops(), 2 * factor.bytes() + sources * vertices * 8};
}

/// Both are the same method: what is compared must agree.
void require_agreement(const std::vector<Eigen::MatrixXd>& own,
                       const std::vector<Eigen::VectorXd>& others) {
  constexpr double kAgreement = 1e-6;
  for (std::size_t i = 0; i < others.size(); ++i) {
    const auto column =
        own[i / HeatGeodesics::kGroup].col(static_cast<int>(i) % HeatGeodesics::kGroup);
    const double difference = (column - others[i]).lpNorm<Eigen::Infinity>();
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
  const FactorSize factor = factor_size(vertices, triangles);
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
