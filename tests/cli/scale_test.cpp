#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_here.h"

namespace mimetra {
namespace {

using nlohmann::json;

/// The same head somewhere else or in another unit.
struct Place {
  std::string name;
  double unit;
  double shift;
};

/// An operation on `head`; the report is that of --json.
struct Measured {
  std::string operation;
  std::string arguments;
  std::vector<std::string> lengths;   ///< keys of what scales with the unit
  std::vector<std::string> squares;   ///< keys of what scales with its square
  std::vector<std::string> unscaled;  ///< keys of what stays as it is
};

class ScaleTest : public test::QuickCommandTest, public testing::WithParamInterface<Measured> {
 protected:
  /// Uneven, so that no rounding decides between two triangulations that are equally good.
  static MorphableModel uneven() {
    const MorphableModel model = test::CommandTest::model();
    Positions mean = model.mean();
    for (Eigen::Index v = 0; v < mean.rows(); ++v) {
      const auto angle = static_cast<double>(v);
      mean.row(v) +=
          0.2 * Eigen::RowVector3d(std::sin(7 * angle), std::cos(5 * angle), std::sin(3 * angle));
    }
    return MorphableModel(std::make_shared<Connectivity>(model.connectivity()), mean,
                          model.identities(), model.expressions());
  }

  static MorphableModel placed(const Place& place) {
    const MorphableModel model = uneven();
    const auto scaled = [&](const ShapeBasis& basis) {
      return ShapeBasis{basis.names, place.unit * basis.displacements};
    };
    return MorphableModel(std::make_shared<Connectivity>(model.connectivity()),
                          (place.unit * model.mean()).array() + place.shift,
                          scaled(model.identities()), scaled(model.expressions()));
  }

  json report(const std::string& arguments) const {
    const bool writes = arguments.find(" -o ") != std::string::npos;
    const auto result = run(arguments + " --json" + (writes ? " --force" : ""));
    EXPECT_EQ(result.code, 0) << result.err;
    return result.code == 0 ? json::parse(result.out) : json();
  }

  /// 1e6 away, coordinates of size 10 keep 10 digits; iterations lose some of them.
  static void expect_equal(const json& found, const json& expected, double factor,
                           const std::string& what) {
    if (expected.is_array()) {
      ASSERT_EQ(found.size(), expected.size()) << what;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        expect_equal(found[i], expected[i], factor, what);
      }
    } else {
      const double value = factor * expected.get<double>();
      EXPECT_NEAR(found.get<double>(), value, 1e-5 * std::abs(value) + 1e-12 * factor) << what;
    }
  }
};

TEST_P(ScaleTest, ChangesNothingButTheUnit) {
  const Measured& measured = GetParam();
  write_model(folder_ / "head", uneven(), std::nullopt, {.overwrite = true});
  const json expected = report(measured.arguments);
  for (const Place& place :
       {Place{"far_away", 1, 1e6}, Place{"micro", 1e-6, 0}, Place{"mega", 1e6, 0}}) {
    write_model(folder_ / "head", placed(place), std::nullopt, {.overwrite = true});
    const json found = report(measured.arguments);
    const auto compare = [&](const std::vector<std::string>& keys, double factor) {
      for (const std::string& key : keys) {
        const json::json_pointer at(key);
        expect_equal(found.at(at), expected.at(at), factor, place.name + key);
      }
    };
    compare(measured.lengths, place.unit);
    compare(measured.squares, place.unit * place.unit);
    compare(measured.unscaled, 1);
  }
}

const Measured kMeasured[] = {
    {"info",
     "info head --weights take.csv",
     {"/extent", "/motion"},
     {},
     {"/degenerate_triangles", "/welded_vertices"}},
    {"align", "align head --weights take.csv --on stable -o a.npy", {}, {}, {"/frames"}},
    {"geodesic", "geodesic head --source 112 -o d.vtp", {"/farthest"}, {}, {"/reached"}},
    {"geodesic_exact",
     "geodesic head --source 112 --geodesics exact -o d.vtp",
     {"/farthest"},
     {},
     {"/reached"}},
    {"decompose",
     "decompose head --weights take.csv -k 3 -o c.h5",
     {"/e_rms"},
     {},
     {"/energies", "/kg", "/centers", "/sparsity"}},
    {"regions",
     "regions head --weights take.csv -k 3 -o r.json",
     {"/regions/0/radius"},
     {},
     {"/vertices", "/triangles", "/energy_share", "/regions/0/center", "/regions/1/center",
      "/regions/2/center"}},
    {"transfer",
     "transfer head --weights take.csv head@wide=1 -k 3 -o x.npy",
     {},
     {"/targets/0/de_all", "/targets/0/de_region"},
     {"/regions/vertices", "/targets/0/condition", "/targets/0/flipped"}},
    {"transfer_vertex",
     "transfer head --weights take.csv head@wide=1 -k 3 --space vertex -o x",
     {},
     {"/targets/0/de_all"},
     {"/targets/0/flipped"}},
    {"evaluate",
     "evaluate head --weights take.csv head@wide=1 -k 3",
     {},
     {"/rows/0/de_all"},
     {"/rows/0/vertices", "/rows/0/triangles"}},
};

INSTANTIATE_TEST_SUITE_P(Every, ScaleTest, testing::ValuesIn(kMeasured),
                         [](const auto& instance) { return instance.param.operation; });

using FarAway = test::QuickCommandTest;

TEST_F(FarAway, FramesKeepTheirMotionInTheDefaultPrecision) {
  const MorphableModel model = FarAway::model();
  const MorphableModel far(std::make_shared<Connectivity>(model.connectivity()),
                           model.mean().array() + 1e6, model.identities(), model.expressions());
  write_model(folder_ / "far", far, performance());
  for (const std::string output : {"frames", "frames --format obj --force"}) {
    ASSERT_EQ(run("convert far --weights take.csv -o " + output).code, 0);
    const MeshSequence written = read_sequence((folder_ / "frames").string()).sequence;
    const MeshSequence expected = far.person().animate(performance().weights);
    // Doubles of this size are 2.4e-10 apart.
    EXPECT_LT((written.positions() - expected.positions()).cwiseAbs().maxCoeff(), 1e-9);
  }
}

}  // namespace
}  // namespace mimetra
