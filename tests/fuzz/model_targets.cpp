#include <cstdint>
#include <initializer_list>
#include <limits>

#include "tests/fuzz/fuzz_target.h"
#include "toolkit/io/bytes.h"
#include "toolkit/io/components_file.h"
#include "toolkit/io/eos.h"
#include "toolkit/io/fit_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/model_file.h"
#include "toolkit/io/whole_file.h"

namespace mimetra::fuzz {

namespace {

Components two_components() {
  Components components;
  components.rest = grid().positions;
  components.triangles = grid().connectivity.triangles;
  components.displacements = Frames::Constant(2, 27, 0.5);
  components.weights = Eigen::MatrixXd::Constant(3, 2, 1);
  components.centers = {4, 0};
  components.support = Eigen::MatrixXd::Constant(2, 9, 0.5);
  components.energies = {2, 1};
  return components;
}

const Target kComponents(
    {"components", "components.h5", [](const fs::path& file) { read_components(file); },
     [](const fs::path& file) { write_components(file, two_components(), true); }});

FittedCoefficients fitted() {
  FittedCoefficients fit;
  fit.identities = {"wide"};
  fit.expressions = {"smile", "brow"};
  fit.times = Eigen::Vector2d(0, 0.04);
  fit.alpha = Eigen::MatrixXd::Constant(2, 1, 0.5);
  fit.beta = Eigen::MatrixXd::Constant(2, 2, 0.25);
  fit.cameras.assign(2, Eigen::Matrix<double, 2, 4>::Constant(2));
  fit.rms = Eigen::Vector2d(1.5, std::numeric_limits<double>::quiet_NaN());
  fit.landmarks = Eigen::Vector2i(68, 0);
  fit.iterations = Eigen::Vector2i(3, 0);
  return fit;
}

const Target kFit({"fit", "a.fit.json", [](const fs::path& file) { read_fit(file).identity(); },
                   [](const fs::path& file) { write_bytes(file, fit_json(fitted())); }});

/// Both files of an eos model: the length of the first stands before them.
void read_eos_pair(const fs::path& file) {
  const std::string bytes = read_file(file);
  const std::size_t shape = bytes.empty() ? 0 : static_cast<unsigned char>(bytes[0]) * 4U;
  const std::string rest = bytes.substr(bytes.empty() ? 0 : 1);
  const fs::path first = file.parent_path() / "sfm_shape_1.bin";
  const fs::path second = file.parent_path() / "expression_blendshapes_1.bin";
  write_bytes(first, rest.substr(0, shape));
  write_bytes(second, shape < rest.size() ? rest.substr(shape) : "");
  is_eos_shape(first);
  read_eos(first, second);
}

/// A triangle with an identity, without colours and texture, and one expression.
void write_eos_start(const fs::path& file) {
  std::string shape, expressions;
  const auto add = [](std::string& bytes, std::initializer_list<std::int32_t> numbers) {
    for (const std::int32_t number : numbers) append_little_endian(bytes, number);
  };
  const auto add_column = [&](std::string& bytes, int rows) {
    add(bytes, {rows, 1});
    for (int row = 0; row < rows; ++row) append_little_endian(bytes, 0.5F * float(row));
  };
  add(shape, {1});
  for (const int rows : {9, 9, 1}) add_column(shape, rows);
  add(shape, {1, 0, 0, 1, 2});
  for (int color = 0; color < 3; ++color) add_column(shape, 0);
  add(shape, {0, 0, 0, 0});
  add(expressions, {1, 0, 4, 0});
  expressions += "jaw_";
  add_column(expressions, 9);
  write_bytes(file, std::string(1, static_cast<char>(shape.size() / 4)) + shape + expressions);
}

const Target kEos({"eos", "pair.bin", read_eos_pair, write_eos_start});

/// What stands after '@' in a model's name, and the paths of a model.json.
const Target kModelSpec({"model_spec", "spec.txt",
                         [](const fs::path& file) { ModelSpec::parse(read_file(file)).name(); },
                         [](const fs::path& file) {
                           write_bytes(file, "actor@identity003=1.5,identity007=-1");
                         }});

const Target kModelJson({"model_json", "model.json",
                         [](const fs::path& file) {
                           write_mesh(file.parent_path() / "neutral.ply", grid());
                           read_model(file.parent_path(), 1);
                         },
                         [](const fs::path& file) {
                           write_bytes(file, R"({"neutral": "neutral.ply"})");
                         }});

}  // namespace

}  // namespace mimetra::fuzz
