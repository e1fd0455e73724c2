#include "toolkit/formats/eos.h"

#include <array>
#include <bit>
#include <cmath>
#include <fstream>

#include "toolkit/io/bytes.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

/// Takes numbers off the front of a file's bytes and checks every count against the bytes that are
/// left.
class BinaryCursor {
 public:
  explicit BinaryCursor(const std::filesystem::path& path)
      : path_(path.string()), bytes_(read_file(path)) {}

  [[noreturn]] void fail(const std::string& message) const {
    throw IoError(path_, "byte " + std::to_string(at_) + ": " + message);
  }

  template <typename Number>
  Number number(const char* what) {
    need(sizeof(Number), what);
    const auto value = number_at<Number>(bytes_.data() + at_, std::endian::little);
    at_ += sizeof(Number);
    return value;
  }

  std::string text(std::uint64_t length) {
    need(length, "a name");
    std::string value = bytes_.substr(at_, length);
    at_ += length;
    return value;
  }

  /// TEX: uint64 n, then n x 2 float64. v points down, like the rows of a picture, and is flipped.
  std::vector<Eigen::Vector2d> texture_coordinates() {
    const char* const what = "the texture coordinates";
    const auto count = number<std::uint64_t>(what);
    if (count > (bytes_.size() - at_) / (2 * sizeof(double))) fail_short(what);
    std::vector<Eigen::Vector2d> coordinates(count);
    for (Eigen::Vector2d& uv : coordinates) {
      uv.x() = number<double>(what);
      uv.y() = 1 - number<double>(what);
      if (!uv.allFinite()) fail(std::string("a number of ") + what + " is not finite");
    }
    return coordinates;
  }

  /// MAT: int32 rows, int32 columns, float32 column-major.
  Eigen::MatrixXd matrix(const char* what) {
    const auto rows = number<std::int32_t>(what), columns = number<std::int32_t>(what);
    if (rows < 0 || columns < 0) fail(std::string("negative size of ") + what);
    const std::uint64_t count = std::uint64_t(rows) * std::uint64_t(columns);
    if (count > (bytes_.size() - at_) / sizeof(float)) fail_short(what);
    Eigen::MatrixXd values(rows, columns);
    for (double& value : values.reshaped()) {
      value = number<float>(what);
      if (!std::isfinite(value)) fail(std::string("a number of ") + what + " is not finite");
    }
    return values;
  }

  /// TRI: uint64 n, then n x 3 int32.
  Triangles triangles() {
    const auto count = number<std::uint64_t>("the triangles");
    if (count > (bytes_.size() - at_) / (3 * sizeof(std::int32_t))) fail_short("the triangles");
    Triangles rows(static_cast<Eigen::Index>(count), 3);
    for (int& index : rows.reshaped<Eigen::RowMajor>())
      index = number<std::int32_t>("the triangles");
    return rows;
  }

  void expect_end() const {
    if (at_ != bytes_.size()) {
      fail(std::to_string(bytes_.size() - at_) + " bytes follow the last part; expected the end");
    }
  }

 private:
  void need(std::uint64_t count, const char* what) const {
    if (count > bytes_.size() - at_) fail_short(what);
  }
  [[noreturn]] void fail_short(const char* what) const {
    fail(std::string("the file ends within ") + what);
  }

  std::string path_;
  std::string bytes_;
  std::size_t at_ = 0;
};

struct ShapeModel {
  Positions mean;
  ShapeBasis basis;
  Triangles triangles;
  std::vector<Eigen::Vector2d> texture;
};

ShapeModel read_shape(const std::filesystem::path& path) {
  BinaryCursor file(path);
  const auto version = file.number<std::uint32_t>("the version");
  if (version != 1) {
    file.fail("an eos model of version " + std::to_string(version) +
              "; only version 1 can be read, convert it with eos");
  }
  ShapeModel model;
  const Eigen::MatrixXd mean = file.matrix("the mean");
  const Eigen::MatrixXd basis = file.matrix("the basis");
  const Eigen::MatrixXd variances = file.matrix("the eigenvalues");
  model.triangles = file.triangles();
  if (mean.cols() != 1 || mean.rows() == 0 || mean.rows() % 3 != 0 || basis.rows() != mean.rows() ||
      variances.rows() != basis.cols() || variances.cols() != 1 || (variances.array() < 0).any()) {
    file.fail("mean, basis and eigenvalues do not fit together; is this an eos shape model?");
  }
  file.matrix("the colour mean");
  file.matrix("the colour basis");
  file.matrix("the colour eigenvalues");
  file.triangles();
  model.texture = file.texture_coordinates();
  file.expect_end();
  model.mean = Eigen::Map<const Positions>(mean.data(), mean.rows() / 3, 3);
  model.basis.displacements = basis * variances.col(0).cwiseSqrt().asDiagonal();
  for (Eigen::Index i = 0; i < basis.cols(); ++i) model.basis.names.push_back(std::to_string(i));
  return model;
}

/// Faces, with texture coordinates if there is one per vertex. Otherwise the file does not say
/// which vertices the coordinates belong to.
Connectivity textured_faces(const ShapeModel& model) {
  const int vertices = static_cast<int>(model.mean.rows());
  Connectivity connectivity = Connectivity::from_triangles(vertices, model.triangles);
  if (model.texture.size() == static_cast<std::size_t>(vertices)) {
    connectivity.texture = {model.texture, connectivity.polygons.corners};
  }
  return connectivity;
}

ShapeBasis read_expressions(const std::filesystem::path& path, Eigen::Index coordinates) {
  BinaryCursor file(path);
  const auto count = file.number<std::uint64_t>("the number of blendshapes");
  ShapeBasis basis;
  std::vector<Eigen::VectorXd> fields;
  for (std::uint64_t i = 0; i < count; ++i) {
    basis.names.push_back(file.text(file.number<std::uint64_t>("the length of a name")));
    const Eigen::MatrixXd field = file.matrix("a blendshape");
    if (field.rows() != coordinates || field.cols() != 1) {
      file.fail("blendshape '" + basis.names.back() + "' has " + std::to_string(field.rows() / 3) +
                " vertices, expected " + std::to_string(coordinates / 3) +
                " as in the shape model");
    }
    fields.push_back(field.col(0));
  }
  file.expect_end();
  basis.displacements.resize(coordinates, static_cast<Eigen::Index>(fields.size()));
  for (std::size_t j = 0; j < fields.size(); ++j) {
    basis.displacements.col(static_cast<Eigen::Index>(j)) = fields[j];
  }
  return basis;
}

/// Latest version of the model file that eos writes.
constexpr std::uint32_t kLatestVersion = 4;

}  // namespace

bool is_eos_shape(const std::filesystem::path& path) {
  std::array<char, 12> head{};
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return false;
  if (!std::ifstream(path, std::ios::binary).read(head.data(), head.size())) return false;
  const auto version = number_at<std::uint32_t>(head.data(), std::endian::little);
  const auto rows = number_at<std::int32_t>(head.data() + 4, std::endian::little);
  const auto columns = number_at<std::int32_t>(head.data() + 8, std::endian::little);
  return version >= 1 && version <= kLatestVersion && rows > 0 && rows % 3 == 0 && columns == 1;
}

MorphableModel read_eos(const std::filesystem::path& shape,
                        const std::filesystem::path& expressions) {
  ShapeModel model = read_shape(shape);
  ShapeBasis basis = read_expressions(expressions, model.mean.size());
  try {
    auto connectivity = std::make_shared<Connectivity>(textured_faces(model));
    return MorphableModel(std::move(connectivity), std::move(model.mean), std::move(model.basis),
                          std::move(basis));
  } catch (const std::invalid_argument& error) {
    throw IoError(shape.string(), error.what());
  }
}

}  // namespace mimetra
