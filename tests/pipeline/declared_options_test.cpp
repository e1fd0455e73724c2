#include <gtest/gtest.h>

#include "tests/option_ranges.h"
#include "toolkit/mesh/alignment.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/pipeline/transfer.h"

namespace mimetra {
namespace {

using test::expect_ranges;

TEST(DeclaredOptions, AreTheRangesThatAlgorithmsCheck) {
  expect_ranges<AlignmentOptions>();
  expect_ranges<DecompositionOptions>();
  expect_ranges<RegionOptions>();
  expect_ranges<BlendshapeTransferOptions>();
  expect_ranges<LocalWeightsOptions>();
  expect_ranges<VertexTransferOptions>();
  expect_ranges<DistanceOptions>();
  expect_ranges<AnalysisOptions>();
  expect_ranges<RegionChoiceOptions>();
  expect_ranges<SolveOptions>();
  expect_ranges<EvaluationOptions>();
  expect_ranges<TransferOptions>();
}

}  // namespace
}  // namespace mimetra
