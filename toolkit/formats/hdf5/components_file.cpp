#include "toolkit/formats/hdf5/components_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "toolkit/formats/hdf5/hdf5_file.h"
#include "toolkit/formats/hdf5/hdf5_image.h"
#include "toolkit/mesh/text.h"

namespace mimetra {

namespace {

using RowMatrix = Frames;

/// `comp000`, `comp001`, ...
std::string component_name(int k) {
  char text[16];
  std::snprintf(text, sizeof text, "comp%03d", k);
  return text;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : file_(path) {}

  [[noreturn]] void fail(const std::string& message) const { file_.fail(message); }
  bool has(const std::string& name) const { return file_.has(name); }

  /// Reads a matrix; a list of numbers becomes one column.
  RowMatrix read(const std::string& name) const {
    const Hdf5Dataset set = file_.dataset(name);
    const auto& shape = set.shape();
    if (shape.empty() || shape.size() > 2) set.fail("is no matrix");
    RowMatrix values(static_cast<Eigen::Index>(shape[0]),
                     static_cast<Eigen::Index>(set.row_size()));
    set.read(0, {values.data(), set.size()});
    if (!values.allFinite()) set.fail("holds a number that is not finite");
    return values;
  }

  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> read_indices(
      const std::string& name) const {
    const RowMatrix values = read(name);
    constexpr double kMost = std::numeric_limits<int>::max();
    for (const double value : values.reshaped()) {
      if (value == std::floor(value) && std::abs(value) <= kMost) continue;
      fail("dataset '" + name + "' holds " + readable(value) + ", expected indices");
    }
    return values.cast<int>();
  }

  bool has_attribute(const char* name) const { return file_.has_attribute(name); }
  double attribute(const char* name, double otherwise) const {
    return file_.attribute(name, otherwise);
  }

  int whole_attribute(const char* name, int otherwise) const {
    const double value = attribute(name, otherwise);
    if (value < 0 || value > std::numeric_limits<int>::max() || value != std::floor(value)) {
      fail(std::string("attribute '") + name + "' is not a count");
    }
    return static_cast<int>(value);
  }

 private:
  Hdf5File file_;
};

void add_option(Hdf5Image& image, const std::string& name, double value) {
  image.add_attribute("", name, Hdf5Array::of(value));
}

void write_options(Hdf5Image& image, const Components& components) {
  const DecompositionOptions& options = components.options;
  add_option(image, "scale", components.scale);
  add_option(image, "d_min", components.d_min);
  add_option(image, "d_max", components.d_max);
  add_option(image, "sparsity", options.sparsity);
  add_option(image, "rho", options.rho);
  if (options.iterations) add_option(image, "iterations", *options.iterations);
  add_option(image, "admm_iterations", options.admm_iterations);
  add_option(image, "tolerance", options.tolerance);
  add_option(image, "nonnegative", options.nonnegative);
  add_option(image, "single_precision", options.precision == IterationPrecision::single_precision);
  add_option(image, "basis_tolerance", options.basis_tolerance);
  add_option(image, "literal_sign_rule", options.sign_rule == SignRule::literal);
  add_option(image, "standard_deviation", options.scale == MotionScale::standard_deviation);
  add_option(image, "last_iterate", options.returned == ReturnedIterate::last);
}

void write_convergence(Hdf5Image& image, const Components& components) {
  if (components.iteration > 0) add_option(image, "iteration", components.iteration);
  if (components.converged) add_option(image, "converged", *components.converged);
}

void read_options(const Reader& reader, Components& components) {
  DecompositionOptions& options = components.options;
  components.scale = reader.attribute("scale", components.scale);
  components.d_min = reader.attribute("d_min", components.d_min);
  components.d_max = reader.attribute("d_max", components.d_max);
  options.count = components.count();
  options.sparsity = reader.attribute("sparsity", options.sparsity);
  options.rho = reader.attribute("rho", options.rho);
  if (reader.has_attribute("iterations")) {
    options.iterations = reader.whole_attribute("iterations", 0);
  }
  options.admm_iterations = reader.whole_attribute("admm_iterations", options.admm_iterations);
  options.tolerance = reader.attribute("tolerance", options.tolerance);
  options.nonnegative = reader.attribute("nonnegative", options.nonnegative) != 0;
  if (reader.attribute("single_precision", false) != 0) {
    options.precision = IterationPrecision::single_precision;
  }
  options.basis_tolerance = reader.attribute("basis_tolerance", options.basis_tolerance);
  options.sign_rule =
      reader.attribute("literal_sign_rule", 0) != 0 ? SignRule::literal : SignRule::amplitude;
  if (reader.attribute("standard_deviation", false) != 0) {
    options.scale = MotionScale::standard_deviation;
  }
  if (reader.attribute("last_iterate", false) != 0) options.returned = ReturnedIterate::last;
}

/// Reads attributes that older files and the reference implementation's files lack.
void read_convergence(const Reader& reader, Components& components) {
  components.iteration = reader.whole_attribute("iteration", 0);
  if (components.iteration > static_cast<int>(components.energies.size())) {
    reader.fail("attribute 'iteration' is " + std::to_string(components.iteration) + ", of " +
                std::to_string(components.energies.size()) + " 'energies'");
  }
  if (reader.has_attribute("converged")) {
    components.converged = reader.attribute("converged", 0) != 0;
  }
}

/// Vertex that each component moves most; -1 if it moves none.
std::vector<VertexIndex> strongest_vertices(const Frames& displacements) {
  std::vector<VertexIndex> centers;
  for (Eigen::Index k = 0; k < displacements.rows(); ++k) {
    const PositionsView field(displacements.row(k).data(), displacements.cols() / 3, 3);
    Eigen::Index strongest = 0;
    const double most = field.rowwise().squaredNorm().maxCoeff(&strongest);
    centers.push_back(most > 0 ? static_cast<VertexIndex>(strongest) : -1);
  }
  return centers;
}

void check_triangles(const Reader& reader, const Components& components) {
  const auto vertices = static_cast<int>(components.rest.rows());
  for (Eigen::Index t = 0; t < components.triangles.rows(); ++t) {
    for (const int vertex : components.triangles.row(t)) {
      if (vertex >= 0 && vertex < vertices) continue;
      reader.fail("triangle " + std::to_string(t) + " uses vertex " + std::to_string(vertex) +
                  ", expected 0 to " + std::to_string(vertices - 1));
    }
  }
}

void read_components_of(const Reader& reader, Components& components) {
  int count = 0;
  while (reader.has(component_name(count))) ++count;
  if (count == 0) reader.fail("holds no component 'comp000'");
  const auto vertices = components.rest.rows();
  components.displacements.resize(count, 3 * vertices);
  for (int k = 0; k < count; ++k) {
    const RowMatrix shape = reader.read(component_name(k));
    if (shape.rows() != vertices || shape.cols() != 3) {
      reader.fail("'" + component_name(k) + "' is " + std::to_string(shape.rows()) + " x " +
                  std::to_string(shape.cols()) + ", expected " + std::to_string(vertices) + " x 3");
    }
    Eigen::Map<Positions>(components.displacements.row(k).data(), vertices, 3) =
        shape - components.rest;
  }
}

void read_optional_parts(const Reader& reader, Components& components) {
  const auto count = components.displacements.rows(), vertices = components.rest.rows();
  if (reader.has("C")) {
    // 'C' is exact; rest + component - rest has lost the last digits.
    components.displacements = reader.read("C");
    if (components.displacements.rows() != count ||
        components.displacements.cols() != 3 * vertices) {
      reader.fail("'C' does not fit the components");
    }
  }
  if (reader.has("W")) components.weights = reader.read("W");
  if (reader.has("support")) components.support = reader.read("support");
  if (components.support.size() > 0 &&
      (components.support.rows() != count || components.support.cols() != vertices)) {
    reader.fail("'support' does not fit the components");
  }
  if (reader.has("energies")) {
    const RowMatrix energies = reader.read("energies");
    components.energies.assign(energies.data(), energies.data() + energies.size());
  }
  components.centers = strongest_vertices(components.displacements);
  if (reader.has("centers")) {
    const auto centers = reader.read_indices("centers");
    components.centers.assign(centers.data(), centers.data() + centers.size());
  }
  const auto is_center = [vertices](int center) { return center >= -1 && center < vertices; };
  if (static_cast<Eigen::Index>(components.centers.size()) != count ||
      !std::ranges::all_of(components.centers, is_center)) {
    reader.fail("'centers' does not fit the components");
  }
  if (components.weights.size() > 0 && components.weights.cols() != count) {
    reader.fail("'W' has " + std::to_string(components.weights.cols()) + " columns, expected " +
                std::to_string(count));
  }
}

}  // namespace

Format::Paths write_components(const std::filesystem::path& path, const Components& components,
                               const WriteOptions& options) {
  Hdf5Image image;
  image.add("default", Hdf5Array::of(components.rest));
  image.add("tris", Hdf5Array::of(components.triangles));
  for (int k = 0; k < components.count(); ++k) {
    const PositionsView field(components.displacements.row(k).data(), components.vertices(), 3);
    image.add(component_name(k), Hdf5Array::of(Positions(components.rest + field)));
  }
  image.add("C", Hdf5Array::of(components.displacements));
  const auto add_matrix = [&image](const std::string& name, const Eigen::MatrixXd& matrix) {
    if (matrix.size() > 0) image.add(name, Hdf5Array::of(RowMatrix(matrix)));
  };
  add_matrix("W", components.weights);
  add_matrix("support", components.support);
  if (!components.centers.empty()) image.add("centers", Hdf5Array::of(components.centers));
  if (!components.energies.empty()) image.add("energies", Hdf5Array::of(components.energies));
  write_options(image, components);
  write_convergence(image, components);
  return write_text(path, options, image.image());
}

Components read_components(const std::filesystem::path& path) {
  const Reader reader(path);
  if (!reader.has("default") && reader.has("verts")) {
    reader.fail("holds a sequence, expected components; `mimetra decompose` makes them of it");
  }
  Components components;
  const RowMatrix rest = reader.read("default");
  const auto triangles = reader.read_indices("tris");
  if (rest.cols() != 3 || triangles.cols() != 3) reader.fail("'default' and 'tris' must be N x 3");
  if (rest.rows() == 0) reader.fail("'default' holds no vertex");
  components.rest = rest;
  components.triangles = triangles;
  check_triangles(reader, components);
  read_components_of(reader, components);
  read_optional_parts(reader, components);
  read_options(reader, components);
  read_convergence(reader, components);
  return components;
}

}  // namespace mimetra
