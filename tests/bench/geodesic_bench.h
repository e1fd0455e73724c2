#pragma once

#include <vector>

#include "tests/bench/subjects.h"
#include "tests/bench/suite.h"

namespace mimetra::bench {

constexpr const char* kGeodesicSetup = "geodesic set-up";
constexpr const char* kGeodesicQuery = "geodesic query";
constexpr const char* kGeodesicAll = "geodesics, set-up included";
constexpr const char* kGeodesicCgal = "geodesics by CGAL's own query";

/// Intrinsic Delaunay mode. CGAL takes manifolds of one component only; throws std::runtime_error
/// where its distances are others.
std::vector<Row> geodesic_rows(const Subject& subject, int sources, bool with_cgal,
                               const Settings& settings);

}  // namespace mimetra::bench
