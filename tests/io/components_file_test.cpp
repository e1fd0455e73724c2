#include <chrono>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/hdf5/components_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

Components small_components() {
  const test::Shape shape = test::grid(4, 3);
  Components components;
  components.rest = shape.positions;
  components.triangles = shape.triangles;
  components.displacements = Eigen::MatrixXd::Random(3, 36);
  components.displacements.row(2).setZero();
  components.weights = Eigen::MatrixXd::Random(5, 3);
  components.centers = {4, 7, -1};
  components.support = Eigen::MatrixXd::Random(3, 12);
  components.energies = {3.5, 2.25, 2.125};
  components.scale = 0.75;
  components.d_min = 0.3;
  components.d_max = 2.1;
  components.options.count = 3;
  components.options.sparsity = 1.5;
  components.options.precision = IterationPrecision::single_precision;
  components.options.basis_tolerance = 1e-3;
  components.options.sign_rule = SignRule::literal;
  return components;
}

TEST(ComponentsFile, ComesBackEqualAfterWriting) {
  const test::TemporaryFolder folder;
  const Components written = small_components();
  write_components(folder / "c.h5", written);
  const Components found = read_components(folder / "c.h5");
  EXPECT_EQ(found.rest, written.rest);
  EXPECT_EQ(found.triangles, written.triangles);
  EXPECT_EQ(found.displacements, written.displacements);
  EXPECT_EQ(found.weights, written.weights);
  EXPECT_EQ(found.centers, written.centers);
  EXPECT_EQ(found.support, written.support);
  EXPECT_EQ(found.energies, written.energies);
  EXPECT_EQ(found.scale, written.scale);
  EXPECT_EQ(found.d_max, written.d_max);
  EXPECT_EQ(found.options.sparsity, 1.5);
  EXPECT_EQ(found.options.sign_rule, SignRule::literal);
  EXPECT_EQ(found.options.precision, IterationPrecision::single_precision);
  EXPECT_EQ(found.options.basis_tolerance, 1e-3);
  // Nothing was said of them.
  EXPECT_EQ(found.converged, std::nullopt);
  EXPECT_EQ(found.iteration, 0);
  EXPECT_EQ(found.options.iterations, std::nullopt);
}

TEST(ComponentsFile, KeepsWhetherTheEnergyConvergedAndWhoseStateItHolds) {
  const test::TemporaryFolder folder;
  Components written = small_components();
  written.options.iterations = 17;
  written.options.returned = ReturnedIterate::last;
  written.iteration = 2;
  for (const bool converged : {false, true}) {
    written.converged = converged;
    const auto file = folder / (converged ? "yes.h5" : "no.h5");
    write_components(file, written);
    const Components found = read_components(file);
    EXPECT_EQ(found.converged, converged);
    EXPECT_EQ(found.iteration, 2);
    EXPECT_EQ(found.options.iterations, 17);
    EXPECT_EQ(found.options.returned, ReturnedIterate::last);
  }
}

TEST(ComponentsFile, OfAnIterationThatDidNotRunIsAnError) {
  const test::TemporaryFolder folder;
  Components components = small_components();
  components.iteration = 4;
  write_components(folder / "c.h5", components);
  EXPECT_THAT([&] { read_components(folder / "c.h5"); },
              testing::ThrowsMessage<IoError>(
                  testing::HasSubstr("attribute 'iteration' is 4, of 3 'energies'")));
}

TEST(ComponentsFile, IsTheSameBytesEveryTime) {
  const test::TemporaryFolder folder;
  const Components components = small_components();
  write_components(folder / "a.h5", components);
  // What is left in freed memory, and the time, must not reach the file.
  { const std::vector<std::string> scribble(1000, std::string(5000, 'x')); }
  const std::time_t second = std::time(nullptr);
  while (std::time(nullptr) == second) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  write_components(folder / "b.h5", components);
  EXPECT_TRUE(read_file(folder / "a.h5") == read_file(folder / "b.h5"));
}

TEST(ComponentsFile, TruncatedAnywhereIsAnError) {
  const test::TemporaryFolder folder;
  write_components(folder / "c.h5", small_components());
  const std::string bytes = read_file(folder / "c.h5");
  for (std::size_t cut = 1; cut <= bytes.size(); cut += 97) {
    const std::size_t length = bytes.size() - cut;
    std::ofstream(folder / "t.h5", std::ios::binary | std::ios::trunc) << bytes.substr(0, length);
    EXPECT_THROW(read_components(folder / "t.h5"), IoError) << length;
  }
}

/// The bytes of a file in which the links `names` have others. The new ones keep the alphabetical
/// order in which HDF5 looks links up, and the file's other content stays as it is.
std::string without_links(std::string bytes, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    // HDF5 stores names with zeros up to a multiple of eight bytes, after the zeros of another.
    std::string stored = '\0' + name + '\0';
    const auto at = bytes.find(stored);
    EXPECT_NE(at, std::string::npos) << name;
    if (at != std::string::npos) bytes[at + name.size()] -= 1;
  }
  return bytes;
}

TEST(ComponentsFile, OfTheReferenceHasComponentsAndNoWeights) {
  const test::TemporaryFolder folder;
  const Components written = small_components();
  write_components(folder / "c.h5", written);
  const std::string bytes = read_file(folder / "c.h5");
  std::ofstream(folder / "r.h5", std::ios::binary)
      << without_links(bytes, {"C", "W", "centers", "support", "energies"});
  const Components found = read_components(folder / "r.h5");
  // comp%03d holds rest + component: coordinates up to 4 round by 4 ulp at most.
  EXPECT_LT((found.displacements - written.displacements).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_EQ(found.weights.size(), 0);
  EXPECT_EQ(found.support.size(), 0);
  EXPECT_TRUE(found.energies.empty());
}

TEST(ComponentsFile, WithoutCentersGetsTheVertexEachComponentMovesMost) {
  const test::TemporaryFolder folder;
  Components components = small_components();
  components.centers.clear();
  components.displacements.row(0).segment<3>(3 * 9) << 0, -5, 0;
  components.displacements.row(1).segment<3>(3 * 2) << 3, 0, 4;
  write_components(folder / "c.h5", components);
  EXPECT_EQ(read_components(folder / "c.h5").centers, (std::vector<VertexIndex>{9, 2, -1}));
}

TEST(ComponentsFile, WithPartsThatDoNotFitOrAreNotFiniteIsAnError) {
  const test::TemporaryFolder folder;
  const auto expect_refusal_with = [&folder](const auto& change) {
    Components components = small_components();
    change(components);
    write_components(folder / "c.h5", components, {.overwrite = true});
    EXPECT_THROW(read_components(folder / "c.h5"), IoError);
  };
  expect_refusal_with([](Components& all) { all.centers = {4, 12, -1}; });
  expect_refusal_with([](Components& all) { all.weights = Eigen::MatrixXd::Ones(5, 2); });
  expect_refusal_with([](Components& all) { all.support = Eigen::MatrixXd::Ones(3, 11); });
  expect_refusal_with(
      [](Components& all) { all.rest(3, 1) = std::numeric_limits<double>::infinity(); });
}

TEST(ComponentsFile, RefusesWhatIsMissingOrNoHdf5) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(read_components(folder / "missing.h5"), IoError);
  std::ofstream(folder / "text.h5") << "text";
  EXPECT_THROW(read_components(folder / "text.h5"), IoError);
}

TEST(ComponentsFile, RefusesToReplaceUnlessTold) {
  const test::TemporaryFolder folder;
  write_components(folder / "c.h5", small_components());
  EXPECT_THROW(write_components(folder / "c.h5", small_components()), OutputError);
}

}  // namespace
}  // namespace mimetra
