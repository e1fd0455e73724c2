#include <gmock/gmock.h>

#include "samples/head/anatomy.h"
#include "tests/samples/full_head.h"
#include "tests/samples/head_fixture.h"
#include "toolkit/pipeline/region_choice.h"

namespace mimetra::test {
namespace {

/// The built-in head with denser teeth over its own, in every sixth frame of its performance.
const MeshSequence& with_teeth() {
  static const MeshSequence head = [] {
    const Eigen::Vector3d left = samples::kLeftEye, right(-left.x(), left.y(), left.z());
    const Eigen::MatrixXd weights = samples::parametric_performance().weights;
    const Eigen::MatrixXd some = weights(Eigen::seqN(0, 20, 6), Eigen::all);
    return full_head(samples::parametric_head().average(), some,
                     {.mouth = {0, samples::kMouthHeight, 80}, .eyes = {left, right}});
  }();
  return head;
}

/// How many of 30 regions lie on the face and not on its teeth, gums, tongue and lashes.
long on_the_face(AnalysisOptions options) {
  // The places are settled by the start; more iterations only take longer.
  options.iterations = 1;
  const Source source = prepare_source(with_teeth(), {.head_motion = HeadMotion::none});
  const Regions regions = choose_regions(analyse(source, options));
  return std::ranges::count_if(regions.regions, [](const Region& region) {
    return region.center < head().vertices() && !is_inside_the_mouth(region.center);
  });
}

TEST(FullHead, HasItsRegionsOnTheFaceUnlessEveryVertexCountsAlike) {
  EXPECT_GE(on_the_face({}), 22);
  EXPECT_LT(on_the_face({.compatibility = Compatibility::splocs2013}), 15);
}

}  // namespace
}  // namespace mimetra::test
