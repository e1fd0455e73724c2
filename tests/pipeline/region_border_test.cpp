#include "toolkit/pipeline/region_choice.h"

#include <algorithm>
#include <functional>
#include <set>

#include <gmock/gmock.h>

#include "tests/pipeline/takes.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/regions/falloff.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// Rising from 0 at x = 1 to 1 at x = 5 on the patch of 9 x 9 vertices.
Eigen::VectorXd ramp(const Positions& positions) {
  return ((positions.col(0).array() - 1) / 4).max(0).min(1);
}

class RegionBorder : public testing::Test {
 protected:
  Selection selected(const Regions& regions, const SolveOptions& options = {}) const {
    return bordered_selection(regions, {"actor", actor_}, options);
  }
  static SolveOptions with_falloff(Length falloff) {
    SolveOptions options;
    options.falloff = falloff;
    return options;
  }

  const MeshSequence take_ = test::take(6);
  const BlendshapeModel actor_ = test::model_on(test::bent_patch(), 5);
  const Regions hard_ = regions_from_vertices(81, take_.triangles(), {{40, 41, 49, 50}, {0}});
  const Regions painted_ = painted_region(ramp(take_.rest()), take_.triangles());
};

TEST_F(RegionBorder, IsHardWithoutPaintingAndFalloff) {
  const Selection plain = selection_of(hard_), bordered = selected(hard_);
  EXPECT_EQ(bordered.weights.size(), 0);
  EXPECT_EQ(bordered.triangles, plain.triangles);
  EXPECT_EQ(bordered.inside, plain.inside);
  EXPECT_EQ(bordered.regions, plain.regions);
  // Weights of each region fade out by themselves.
  SolveOptions per_region = with_falloff(Length::share(0.3));
  per_region.per_region = true;
  EXPECT_EQ(selected(hard_, per_region).weights.size(), 0);
}

TEST_F(RegionBorder, IsWhatWasPainted) {
  const Selection selection = selected(painted_);
  EXPECT_TRUE(selection.weights == ramp(take_.rest()));
  EXPECT_EQ(selection.triangles, triangles_in(selection.weights, take_.triangles()));
  for (int v = 0; v < 81; ++v) EXPECT_EQ(selection.inside[v], selection.weights[v] > 0) << v;
}

TEST_F(RegionBorder, FadesOutAlongTheTargetsSurface) {
  const SurfaceDistances distances(actor_.neutral(), actor_.triangles(),
                                   Weld::exact(actor_.neutral()));
  Eigen::VectorXd held = Eigen::VectorXd::Zero(81);
  for (const int v : {0, 40, 41, 49, 50}) held[v] = 1;
  const Eigen::VectorXd expected = fading_out(
      held, actor_.triangles(), distances.weld(), 0.2 * diameter(actor_.neutral()),
      [&](std::span<const VertexIndex> sources) { return distances.from_nearest(sources); });
  const Selection selection = selected(hard_, with_falloff(Length::share(0.2)));
  EXPECT_TRUE(selection.weights == expected);
  EXPECT_GT(selection.triangles.size(), hard_.triangles.size());
  EXPECT_EQ(selection.regions.front(), hard_.regions.front().vertices);
  EXPECT_TRUE(selected(hard_, with_falloff(Length::of(0.2 * diameter(actor_.neutral())))).weights ==
              expected);
}

TEST_F(RegionBorder, IsAsWideWhateverPartsLieBesideTheRegions) {
  test::Shape body = test::grid(3, 3);
  body.positions *= 10 * diameter(actor_.neutral());
  const test::Shape shape = both({actor_.neutral(), actor_.triangles()}, body);
  const BlendshapeModel beside(test::mesh_of(shape), {});
  const Regions regions = regions_from_vertices(90, shape.triangles, {{40, 41, 49, 50}, {0}});
  const SolveOptions options = with_falloff(Length::share(0.2));
  EXPECT_TRUE(bordered_selection(regions, {"beside", beside}, options).weights.head(81) ==
              selected(hard_, options).weights);
}

TEST_F(RegionBorder, FadesOutAroundWhatIsPaintedOne) {
  const Eigen::VectorXd painted = ramp(take_.rest());
  const Eigen::VectorXd faded = selected(painted_, with_falloff(Length::share(0.4))).weights;
  EXPECT_TRUE(((faded - painted).array() >= 0).all());
  EXPECT_GT((faded - painted).maxCoeff(), 0.01);
  const Regions half = painted_region(painted / 2, take_.triangles());
  EXPECT_EQ(test::topic_of([&] { selected(half, with_falloff(Length::share(0.4))); }),
            Topic::no_full_weight);
  EXPECT_THAT([&] { selected(half, with_falloff(Length::share(0.4))); },
              ThrowsMessage<OptionError>(testing::AllOf(
                  HasSubstr("actor: no vertex has the weight 1"), HasSubstr("0.5"))));
}

TEST_F(RegionBorder, MustBeALengthInRange) {
  EXPECT_THAT([&] { selected(hard_, with_falloff(Length::share(0))); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("falloff is 0")));
  EXPECT_THAT([&] { selected(hard_, with_falloff(Length::share(12))); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("falloff is 12")));
}

TEST_F(RegionBorder, IsOneWeightAtAWeldedPlace) {
  test::Shape halves = test::both(test::grid(3, 3), test::grid(3, 3));
  halves.positions.bottomRows(9).col(0).array() += 2;
  const BlendshapeModel model(test::connectivity_of(halves), halves.positions,
                              ShapeBasis{{}, Eigen::MatrixXd(54, 0)});
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(18);
  weights[2] = 0.25;  // at the seam, on one side
  const Regions painted = painted_region(weights, halves.triangles);
  SolveOptions options;
  const Selection joined = bordered_selection(painted, {"halves", model}, options);
  EXPECT_EQ(joined.weights[2], 0.25);
  EXPECT_EQ(joined.weights[9], 0.25);
  EXPECT_EQ(joined.weights.sum(), 0.5);
  EXPECT_TRUE(joined.inside[9]);
  options.distances = DistanceOptions{.welding = Welding::none};
  EXPECT_EQ(bordered_selection(painted, {"halves", model}, options).weights.sum(), 0.25);
}

TEST_F(RegionBorder, IsInTheResultOfATransfer) {
  TransferOptions options;
  options.given = GivenRegions{"painting", painted_};
  const TransferResult painted = transfer(take_, {{"actor", actor_}}, options);
  EXPECT_TRUE(painted.targets[0].weights == ramp(take_.rest()));
  ASSERT_TRUE(painted.regions);
  EXPECT_TRUE(painted.regions->weights == painted.targets[0].weights);
  EXPECT_EQ(painted.regions->regions.size(), 1U);  // no disc completes it

  options.given = GivenRegions{"list", hard_};
  options.regions.complete = 0;
  EXPECT_EQ(transfer(take_, {{"actor", actor_}}, options).targets[0].weights.size(), 0);
  options.solve.falloff = Length::share(0.2);
  const TransferResult faded = transfer(take_, {{"actor", actor_}, {"same", actor_}}, options);
  EXPECT_TRUE(faded.targets[0].weights == selected(hard_, options.solve).weights);
  EXPECT_TRUE(faded.targets[0].weights == faded.targets[1].weights);
  // Those of several targets need not be one.
  EXPECT_EQ(faded.regions->weights.size(), 0);
  EXPECT_EQ(faded.targets[0].regions->triangles,
            triangles_in(faded.targets[0].weights, take_.triangles()));
}

TEST_F(RegionBorder, IsRefusedWhereNothingCouldFollowIt) {
  TransferOptions options{.full = true};
  options.solve.falloff = Length::share(0.2);
  const auto message = [&] { transfer(take_, {{"actor", actor_}}, options); };
  EXPECT_THAT(message, ThrowsMessage<std::invalid_argument>(HasSubstr("falloff: a full transfer")));
  options = {};
  options.given = GivenRegions{"painting", painted_};
  options.solve.per_region = true;
  EXPECT_THAT(message, ThrowsMessage<std::invalid_argument>(
                           HasSubstr("per_region: painting says how much")));
  EvaluationOptions of_rows{.given = GivenRegions{"painting", painted_}};
  of_rows.solve.per_region = true;
  EXPECT_THAT(
      [&] {
        evaluate(take_, {"actor", actor_}, of_rows);
      },
      ThrowsMessage<std::invalid_argument>(HasSubstr("per_region: painting says how much")));
}

TEST_F(RegionBorder, IsRefusedBeforeAnythingIsComputed) {
  const Regions half = painted_region(0.5 * ramp(take_.rest()), take_.triangles());
  const GivenRegions given{"half", half};
  const Target actor{"actor", actor_};
  SolveOptions options = with_falloff(Length::share(0.2));
  EXPECT_THAT([&] { check_border(&given, actor, options); },
              ThrowsMessage<OptionError>(HasSubstr("half: no vertex has the weight 1")));
  EXPECT_EQ(test::topic_of([&] { check_border(&given, actor, options); }), Topic::no_full_weight);
  EXPECT_NO_THROW(check_border(nullptr, actor, options));
  options.outside = Outside::identity;
  EXPECT_NO_THROW(check_border(nullptr, actor, options));
  options.space = Space::vertex;
  EXPECT_EQ(test::topic_of([&] { check_border(nullptr, actor, options); }), Topic::soft_outside);
  options.falloff = {};
  EXPECT_NO_THROW(check_border(nullptr, actor, options));
  EXPECT_EQ(test::topic_of([&] { check_border(&given, actor, options); }), Topic::soft_outside);

  // Nothing is asked of the sequence.
  const Context stopped = Context().with_progress(
      [](double) -> bool { throw std::logic_error("something was computed"); });
  TransferOptions of_transfer{.solve = options};
  of_transfer.solve.falloff = Length::share(0.2);
  EXPECT_EQ(test::topic_of([&] { transfer(take_, {actor}, of_transfer, stopped); }),
            Topic::soft_outside);
  const EvaluationOptions of_rows{.solve = of_transfer.solve};
  EXPECT_EQ(test::topic_of([&] { evaluate(take_, actor, of_rows, stopped); }), Topic::soft_outside);
}

TEST_F(RegionBorder, IsEvaluatedInARowOfItsOwn) {
  EvaluationOptions options{.given = GivenRegions{"painting", painted_}};
  const std::vector<EvaluationRow> rows = evaluate(take_, {"actor", actor_}, options);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_FALSE(rows[0].k);
  EXPECT_EQ(rows[0].vertices, painted_.vertex_count());
  EXPECT_EQ(rows[0].triangles, static_cast<int>(painted_.triangles.size()));
  EXPECT_EQ(rows[1].triangle_share, 1);
  EvaluationOptions hard{.given = GivenRegions{"list", hard_}};
  hard.regions.complete = 0;
  const int of_hard = evaluate(take_, {"actor", actor_}, hard)[0].triangles;
  EXPECT_EQ(of_hard, static_cast<int>(hard_.triangles.size()));
  hard.solve.falloff = Length::share(0.2);
  EXPECT_GT(evaluate(take_, {"actor", actor_}, hard)[0].triangles, of_hard);
}

/// A flat grid, and the same with four times the faces, of which some have no partner.
class CarriedWeights : public testing::Test {
 protected:
  /// Triangles of the target for which `has_partner` is false are a gap.
  Pairing pairing(const std::function<bool(int)>& has_partner) const {
    Correspondence pairs;
    pairs.source_triangles = static_cast<int>(coarse_.triangles.rows());
    for (int t = 0; t < fine_.triangles.rows(); ++t) {
      if (has_partner(t)) pairs.parts.push_back({t / 4, 1.0});
      pairs.offsets.push_back(static_cast<int>(pairs.parts.size()));
    }
    pairs.residuals = Eigen::VectorXd::Zero(fine_.triangles.rows());
    return {test::mesh_of(coarse_), test::mesh_of(fine_), std::move(pairs)};
  }
  Eigen::VectorXd carried(const Eigen::VectorXd& weights, const Pairing& pairing) const {
    return carried_weights(weights, pairing, Weld::exact(fine_.positions), fine_.triangles);
  }
  /// Fine triangles whose centre is within 1.4 of (3, 3).
  bool is_in_hole(int t) const {
    Eigen::RowVector3d center = Eigen::RowVector3d::Zero();
    for (const VertexIndex v : fine_.triangles.row(t)) center += fine_.positions.row(v) / 3;
    return (center.head<2>() - Eigen::RowVector2d(3, 3)).norm() < 1.4;
  }

  const test::Shape coarse_ = test::grid(7, 7);
  const test::Shape fine_ = test::subdivided(test::grid(7, 7));
};

TEST_F(CarriedWeights, AreThoseOfTheCarriersLinearly) {
  const Eigen::VectorXd weights = (coarse_.positions.col(0) + 2 * coarse_.positions.col(1)) / 18;
  const Pairing all = pairing([](int) { return true; });
  const Eigen::VectorXd found = carried(weights, all);
  for (int v = 0; v < found.size(); ++v) {
    double sum = 0;
    for (const auto& [vertex, share] : all.carriers(v)) sum += share * weights[vertex];
    EXPECT_NEAR(found[v], sum, 1e-15) << v;
    // Inside, where carriers lie evenly around a vertex, that is the place's own weight.
    const double x = fine_.positions(v, 0), y = fine_.positions(v, 1);
    const bool is_inside = std::min(x, y) > 0 && std::max(x, y) < 6;
    EXPECT_NEAR(found[v], is_inside ? (x + 2 * y) / 18 : sum, 1e-12) << v;
  }
}

TEST_F(CarriedWeights, OfEqualOnesAreEqualBitByBit) {
  const Pairing all = pairing([](int) { return true; });
  const Pairing holed = pairing([this](int t) { return !is_in_hole(t); });
  for (const double weight : {0.0, 1.0}) {
    const Eigen::VectorXd weights = Eigen::VectorXd::Constant(49, weight);
    EXPECT_TRUE((carried(weights, all).array() == weight).all());
    EXPECT_TRUE((carried(weights, holed).array() == weight).all());
  }
  EXPECT_TRUE((carried(Eigen::VectorXd::Constant(49, 0.3), all).array() == 0.3).all());
}

TEST_F(CarriedWeights, AreTheMeanOfTheirNeighboursInAGap) {
  const Pairing holed = pairing([this](int t) { return !is_in_hole(t); });
  const Eigen::VectorXd weights = coarse_.positions.col(0) / 6;
  const Eigen::VectorXd found = carried(weights, holed);
  std::vector<std::set<int>> neighbors(found.size());
  for (const auto& corners : fine_.triangles.rowwise()) {
    for (const int a : corners) {
      for (const int b : corners) {
        if (a != b) neighbors[a].insert(b);
      }
    }
  }
  int without = 0;
  for (int v = 0; v < found.size(); ++v) {
    if (!holed.carriers(v).empty()) continue;
    ++without;
    double mean = 0;
    for (const int w : neighbors[v]) mean += found[w] / static_cast<double>(neighbors[v].size());
    EXPECT_NEAR(found[v], mean, 1e-12) << v;
    EXPECT_GT(found[v], 0);
    EXPECT_LT(found[v], 1);
  }
  EXPECT_GE(without, 5);
}

TEST_F(CarriedWeights, AreNoneOnPartsWithoutPartner) {
  // Only the triangles of the lower rows have one; the upper part hangs on them, a tooth does not.
  const test::Shape tooth = test::both(fine_, test::grid(2, 2));
  Correspondence pairs;
  pairs.source_triangles = static_cast<int>(coarse_.triangles.rows());
  for (int t = 0; t < tooth.triangles.rows(); ++t) {
    if (t < fine_.triangles.rows()) pairs.parts.push_back({t / 4, 1.0});
    pairs.offsets.push_back(static_cast<int>(pairs.parts.size()));
  }
  pairs.residuals = Eigen::VectorXd::Zero(tooth.triangles.rows());
  const Pairing pairing(test::mesh_of(coarse_), test::mesh_of(tooth), std::move(pairs));
  const auto count = static_cast<int>(tooth.positions.rows());
  const Eigen::VectorXd found =
      carried_weights(Eigen::VectorXd::Ones(49), pairing, Weld::none(count), tooth.triangles);
  EXPECT_EQ(found.head(count - 4).minCoeff(), 1);
  EXPECT_EQ(found.tail(4).maxCoeff(), 0);
}

TEST_F(CarriedWeights, OfPartsThatFollowAreThoseOfTheSurfaceAround) {
  // A pebble on each end of the target, of which the source has none.
  test::Shape pebble = test::octahedron();
  pebble.positions *= 0.05;
  test::Shape left = pebble, right = pebble;
  left.positions.rowwise() += Eigen::RowVector3d(1, 3, 0.05);
  right.positions.rowwise() += Eigen::RowVector3d(5, 3, 0.05);
  const test::Shape all = test::both(test::both(fine_, left), right);
  Correspondence pairs;
  pairs.source_triangles = static_cast<int>(coarse_.triangles.rows());
  for (int t = 0; t < all.triangles.rows(); ++t) {
    if (t < fine_.triangles.rows()) pairs.parts.push_back({t / 4, 1.0});
    pairs.offsets.push_back(static_cast<int>(pairs.parts.size()));
  }
  pairs.residuals = Eigen::VectorXd::Zero(all.triangles.rows());
  const BlendshapeModel model(test::connectivity_of(all), all.positions,
                              ShapeBasis{{}, Eigen::MatrixXd(all.positions.size(), 0)});
  Target target{"with pebbles", model};
  target.pairing =
      std::make_shared<const Pairing>(test::mesh_of(coarse_), test::mesh_of(all), std::move(pairs));
  const Eigen::VectorXd ramp = (coarse_.positions.col(0).array() - 1.5).max(0).min(1);
  const Eigen::Index face = fine_.positions.rows();
  const Eigen::VectorXd found =
      bordered_selection(painted_region(ramp, coarse_.triangles), target, {}).weights;
  // What is near them has these weights.
  EXPECT_TRUE((found.segment(face, 6).array() == found[face]).all());
  EXPECT_NEAR(found[face], 0, 0.1);
  EXPECT_TRUE((found.tail(6).array() == 1).all());

  SolveOptions fades;
  fades.falloff = Length::share(0.2);
  const Regions hard = regions_from_vertices(49, coarse_.triangles, {{26, 27, 33, 34}});
  const Eigen::VectorXd faded = bordered_selection(hard, target, fades).weights;
  EXPECT_GT(faded.tail(6).minCoeff(), 0.3);
  EXPECT_EQ(faded.segment(face, 6).maxCoeff(), 0);
}

TEST_F(CarriedWeights, AreWhatAPairedTargetTakes) {
  const MeshSequence take(*test::connectivity_of(coarse_),
                          Positions(coarse_.positions).reshaped<Eigen::RowMajor>().transpose());
  const BlendshapeModel model(test::connectivity_of(fine_), fine_.positions,
                              ShapeBasis{{}, Eigen::MatrixXd(fine_.positions.size(), 0)});
  const auto pairs = std::make_shared<const Pairing>(pairing([](int) { return true; }));
  Target target{"fine", model};
  target.pairing = pairs;
  const Eigen::VectorXd weights = coarse_.positions.col(0) / 6;
  const Regions painted = painted_region(weights, coarse_.triangles);
  const Selection selection = bordered_selection(painted, target, {});
  EXPECT_TRUE(selection.weights == carried(weights, *pairs));
  EXPECT_EQ(selection.triangles, triangles_in(selection.weights, fine_.triangles));
  EXPECT_TRUE(with_border(painted, selection, target).weights == weights);

  const auto left = std::make_shared<const Pairing>(
      pairing([this](int t) { return fine_.positions(fine_.triangles(t, 0), 0) > 3.2; }));
  target.pairing = left;
  const Regions corner = painted_region(Eigen::VectorXd::Unit(49, 0), coarse_.triangles);
  EXPECT_THAT([&] { bordered_selection(corner, target, {}); },
              ThrowsMessage<MismatchError>(HasSubstr("fine: none of its vertices lies over")));
}

}  // namespace
}  // namespace mimetra
