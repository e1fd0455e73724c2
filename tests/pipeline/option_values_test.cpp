#include <cmath>
#include <functional>

#include "tests/pipeline/option_values.h"
#include "tests/pipeline/takes.h"
#include "toolkit/correspondence/face_landmarks.h"
#include "toolkit/correspondence/surface_fit.h"
#include "toolkit/mesh/simplification.h"
#include "toolkit/mesh/subdivision.h"
#include "toolkit/mesh/unit_change.h"
#include "toolkit/pipeline/measure.h"
#include "toolkit/pipeline/region_choice.h"
#include "toolkit/pipeline/retarget.h"
#include "toolkit/pipeline/rig.h"
#include "toolkit/transfer/joint_fit.h"
#include "toolkit/transfer/region_selection.h"

/// No option is ignored: algorithms refuse values out of range, and other values change results.
namespace mimetra {
namespace {

using test::Digest;
using test::expect_all_count;
using test::frames_of;

/// A performance of a patch, and another patch whose expressions have names of ARKit.
class OptionValues : public testing::Test {
 protected:
  OptionValues() {
    ShapeBasis basis = test::bumps(test::bent_patch().positions, 6);
    basis.names = {"eyeLookUpLeft",   "eyeLookDownLeft", "mouthSmileLeft",
                   "mouthSmileRight", "jawOpen",         "mouthClose"};
    actor_ = BlendshapeModel(take_.shared_connectivity(), test::bent_patch().positions, basis);
    mesh_ = BlendshapeModel(take_.shared_connectivity(), test::bent_patch().positions, {});
  }

  Source source() const { return prepare_source(take_, {.head_motion = HeadMotion::none}); }
  GivenRegions regions() const {
    return {"some", regions_from_vertices(81, take_.triangles(), {{10, 11, 19, 20}, {40, 41, 49}})};
  }
  static Digest digest(const TransferResult& result) {
    const TransferredTarget& target = result.targets.front();
    return Digest(frames_of(target.solution.sequence),
                  target.regions ? target.regions->triangles : std::vector<int>());
  }
  static Digest digest(const std::vector<EvaluationRow>& rows) {
    std::vector<double> numbers;
    for (const EvaluationRow& row : rows) {
      numbers.insert(numbers.end(), {row.triangle_share, row.de_all, row.de_region, row.crease});
    }
    return Digest(numbers);
  }

  const BlendshapeModel model_ = test::model_on(test::patch(), 6);
  const MeshSequence take_ = model_.animate(test::random_weights(8, 6));
  const MeshSequence nods_ = with_motion(take_, test::nodding(8));
  const std::vector<int> all_ = all_triangles(take_.triangles());
  const std::vector<int> half_ = test::half_of(take_.triangles());
  BlendshapeModel actor_, mesh_;
};

TEST_F(OptionValues, OfMeshesCount) {
  expect_all_count<AlignmentOptions>({{}}, [&](const auto& options) {
    return Digest(align(nods_, options).sequence.positions());
  });
  expect_all_count<SimplifyOptions>(
      {{}}, [&](const auto& options) { return Digest(simplify(take_, options).vertices); });
  expect_all_count<SubdivideOptions>({{}}, [&](const auto& options) {
    return Digest(Eigen::MatrixXd(subdivide(take_.rest(), take_.connectivity(), options).weights));
  });
  expect_all_count<UnitChange>({{}}, [&](const auto& options) {
    return Digest(frames_of(with_units(std::make_shared<const MeshSequence>(take_), options)));
  });
}

TEST_F(OptionValues, OfDecompositionsAndTheirRegionsCount) {
  const DecompositionOptions few{.count = 3, .iterations = 8, .admm_iterations = 2, .tolerance = 0};
  expect_all_count<DecompositionOptions>({few}, [&](const auto& options) {
    const Components components = decompose(take_, options);
    return Digest(components.displacements, components.weights, components.energies);
  });
  const Components components = decompose(take_, few);
  expect_all_count<RegionOptions>({{.coverage = 0.3}}, [&](const auto& options) {
    return Digest(find_regions(components, options).triangles);
  });
}

/// Finds the same face in every picture. Landmarks shift from picture to picture, the later ones
/// farther.
std::optional<FoundFace> shaky_face(const GreyImage& image) {
  unsigned hash = 0;
  for (const std::uint8_t pixel : image.pixels) hash = 31 * hash + pixel;
  FoundFace face;
  face.confidence = 0.5;
  for (int i = 0; i < kFaceLandmarks; ++i) {
    const bool is_eye = i >= 36 && i < 48, is_lip = i >= 48;
    const double middle_x = is_eye ? (i < 42 ? -0.2 : 0.2) : 0;
    const double middle_y = is_eye ? 0.2 : is_lip ? -0.2 : 0;
    const double shift = 1e-3 * i * (hash / 7 % 5);
    face.landmarks.row(i) << image.width * (0.5 + middle_x + 0.05 * std::cos(i) + shift),
        image.width * (0.5 - middle_y - 0.05 * std::sin(i));
  }
  return face;
}

TEST_F(OptionValues, OfCorrespondencesCount) {
  std::vector<Marker> markers;
  for (const VertexIndex v : {1, 7, 9, 40, 44, 63, 71, 78}) markers.push_back({v, v});
  const TriMesh source = test::mesh_of(test::patch()), target = test::mesh_of(test::bent_patch());
  expect_all_count<SurfaceFitOptions>({{.steps = 2}}, [&](const auto& options) {
    return Digest(fit_to_surface(source, target, markers, options).positions);
  });
  const Head head{"ball", test::mesh_of(test::sphere(3))};
  expect_all_count<FaceSearchOptions>({{.pixels = 96}}, [&](const auto& options) {
    std::vector<double> places;
    for (const FaceLandmark& landmark : find_landmarks(head, shaky_face, options).found) {
      places.insert(places.end(), landmark.place.begin(), landmark.place.end());
    }
    return Digest(places);
  });
}

TEST_F(OptionValues, OfWeightsCount) {
  expect_all_count<BlendshapeTransferOptions>({{}}, [&](const auto& options) {
    return Digest(BlendshapeTransfer(take_.rest(), actor_, half_, options).weights(take_));
  });
  const Eigen::MatrixXd global = BlendshapeTransfer(take_.rest(), actor_, all_).weights(take_);
  Eigen::MatrixXd halves(81, 2);
  halves.col(0) = test::patch().positions.col(0) / 8;
  halves.col(1) = 1 - halves.col(0).array();
  expect_all_count<LocalWeightsOptions>({{}}, [&](const auto& options) {
    const LocalWeights local(take_.rest(), actor_, halves.sparseView(), all_, options);
    return Digest(local.weights(take_, global).beta);
  });
  expect_all_count<JointFitOptions>({{.iterations = 3}}, [&](const auto& options) {
    const JointFit fit(take_.rest(), actor_, all_, options);
    return Digest(fit(nods_, std::vector<RigidTransform>(8)).weights);
  });
}

TEST_F(OptionValues, OfPositionsCount) {
  expect_all_count<VertexTransferOptions>(
      {{.outside = Outside::identity},
       {.outside = Outside::identity, .anchor = Anchor::vertex, .anchor_vertex = 3}},
      [&](const auto& options) {
        return Digest(
            VertexTransfer(take_.rest(), mesh_.neutral(), mesh_.triangles(), half_, options)
                .frames(take_));
      });
  const MeshSequence result = actor_.animate(test::random_weights(8, 6));
  expect_all_count<TransferErrorOptions>({{}}, [&](const auto& options) {
    return Digest(transfer_error(take_, result, half_, options).per_triangle);
  });
}

TEST_F(OptionValues, OfRegionsForATargetCount) {
  const SurfaceDistances distances = distances_along(take_.rest(), take_.triangles());
  expect_all_count<RegionSelectionOptions>({{}}, [&](const auto& options) {
    return Digest(RegionSelection(take_, actor_, options).criterion(half_));
  });
  std::vector<CompletionOptions> bases;
  for (int i = 1; i < 10; ++i) bases.push_back({.share = 0.05 * i, .limit = 0.1 * i});
  expect_all_count(bases, [&](const auto& options) {
    DiscSearch search(take_.rest(), take_.triangles(), distances, 1.5);
    return Digest(completed(regions().regions, actor_, search, options).regions.triangles);
  });
}

TEST_F(OptionValues, OfAnalysesCount) {
  test::Shape halves = test::both(test::grid(5, 5), test::grid(5, 5));
  halves.positions.bottomRows(25).col(0).array() += 4;
  // The heat method works on other triangles than heat-direct where the mesh is not Delaunay.
  halves.positions.col(0) += 0.8 * halves.positions.col(1);
  expect_all_count<DistanceOptions>({{}}, [&](const auto& options) {
    return Digest(distances_along(halves.positions, halves.triangles, options)(0));
  });
  expect_all_count<AnalysisOptions>(
      {{.count = 3, .iterations = 8, .admm_iterations = 2},
       {.count = 3, .iterations = 8, .admm_iterations = 2, .tolerance = 0}},
      [&](const auto& options) {
        const Components components = analyse(source(), options).components;
        return Digest(components.displacements, components.weights, components.energies);
      });
}

TEST_F(OptionValues, OfRegionChoicesCount) {
  const GivenComponents components{"six", decompose(take_, {.count = 6, .iterations = 5})};
  const auto by_components = [&](const RegionChoiceOptions& options) {
    return digest(transfer(take_, {{"actor", actor_}}, {.given = components, .regions = options}));
  };
  const auto by_regions = [&](const RegionChoiceOptions& options) {
    return digest(transfer(take_, {{"actor", actor_}}, {.given = regions(), .regions = options}));
  };
  const auto by_simplified = [&](const RegionChoiceOptions& options) {
    const AnalysisOptions few{.count = 3, .iterations = 5};
    return Digest(regions_by_simplified(source(), {.share = 0.5}, few, options).regions.triangles);
  };
  expect_all_count<RegionChoiceOptions>(
      {{{}, by_components},
       {{.coverage = 0.3, .complete = 0}, by_components},
       {{.select = Selector::transfer, .radius = Length::share(0.3)}, by_components},
       {{.complete = 0.9, .complete_limit = 0.1}, by_regions},
       {{.coverage = 0.3}, by_simplified}});
}

TEST_F(OptionValues, OfSolvesCount) {
  using Compute = std::function<Digest(const Target&, const SolveOptions&)>;
  const Compute transfers = [&](const Target& target, const SolveOptions& options) {
    return digest(transfer(take_, {target}, {.given = regions(), .solve = options}));
  };
  const Compute evaluates = [&](const Target& target, const SolveOptions& options) {
    return digest(evaluate(take_, target, {.given = regions(), .solve = options}));
  };
  for (const Compute& compute : {transfers, evaluates}) {
    const auto actor = [&](const SolveOptions& options) {
      return compute({"actor", actor_}, options);
    };
    const auto mesh = [&](const SolveOptions& options) {
      return compute({"mesh", mesh_}, options);
    };
    expect_all_count<SolveOptions>(
        {{{}, actor},
         {{.per_region = true}, actor},
         {{.space = Space::vertex}, actor},
         {{.outside = Outside::identity}, mesh},
         {{.outside = Outside::identity, .anchor = Anchor::vertex, .anchor_vertex = 3}, mesh}});
  }
}

TEST_F(OptionValues, OfTransfersAndEvaluationsCount) {
  expect_all_count<TransferOptions>(
      {{.given = regions(), .source = {.head_motion = HeadMotion::all}}}, [&](const auto& options) {
        return digest(transfer(nods_, {{"actor", actor_}}, options));
      });
  expect_all_count<EvaluationOptions>(
      {{.counts = {2}, .analysis = {.iterations = 2}, .regions = {.radius = Length::share(0.2)}}},
      [&](const auto& options) {
        return digest(evaluate(take_, {"actor", actor_}, options));
      });
}

TEST_F(OptionValues, OfRigsCount) {
  const auto displacements = [&](const RigOptions& options) {
    const std::vector<RigExample> examples = {
        {"shape1", Positions(mesh_.neutral().array() * 1.01), 1},
        {"unknown", actor_.pose(Eigen::VectorXd::Constant(6, 0.5))}};
    const Rig made = rig(model_, {"mesh", mesh_}, examples, options);
    return Digest(made.model.expressions().displacements);
  };
  expect_all_count<RigOptions>({{}}, displacements);
  expect_all_count<ExampleRigOptions>(
      {{.rounds = 2}}, [&](const auto& options) { return displacements({.examples = options}); });
  const Animation animation(std::make_shared<const BlendshapeModel>(model_),
                            test::random_weights(8, 6));
  expect_all_count<RetargetOptions>({{}}, [&](const auto& options) {
    const RetargetResult result = retarget(animation, {"actor", actor_}, options);
    return Digest(result.transferred.solution.weights(),
                  result.map ? result.map->linear : Eigen::MatrixXd());
  });
}

}  // namespace
}  // namespace mimetra
