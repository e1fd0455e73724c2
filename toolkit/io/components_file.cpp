#include "toolkit/io/components_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "toolkit/io/pending_output.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {

namespace {

using RowMatrix = Frames;

/// An HDF5 identifier and the function that closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  operator hid_t() const { return id_; }
  bool is_open() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// HDF5 prints its errors on stderr unless it is switched off; a library does not print.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// `comp000`, `comp001`, ...
std::string component_name(int k) {
  char text[16];
  std::snprintf(text, sizeof text, "comp%03d", k);
  return text;
}

template <typename Scalar>
hid_t memory_type() {
  return std::is_same_v<Scalar, int> ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE;
}

class Writer {
 public:
  Writer(const std::filesystem::path& path, const std::filesystem::path& target)
      : target_(target.string()),
        access_(in_memory(), H5Pclose),
        file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access_), H5Fclose),
        creation_(H5Pcreate(H5P_DATASET_CREATE), H5Pclose) {
    check(file_.is_open());
    // Without time stamps the same components are the same bytes.
    check(H5Pset_obj_track_times(creation_, false) >= 0);
  }

  template <typename Matrix>
  void write(const std::string& name, const Matrix& matrix) {
    using Scalar = typename Matrix::Scalar;
    const Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
    const hsize_t sizes[2] = {hsize_t(rows.rows()), hsize_t(rows.cols())};
    const bool is_vector = Matrix::ColsAtCompileTime == 1;
    const Handle space(H5Screate_simple(is_vector ? 1 : 2, sizes, nullptr), H5Sclose);
    const hid_t stored = std::is_same_v<Scalar, int> ? H5T_STD_I32LE : H5T_IEEE_F64LE;
    const Handle set(
        H5Dcreate2(file_, name.c_str(), stored, space, H5P_DEFAULT, creation_, H5P_DEFAULT),
        H5Dclose);
    check(set.is_open() && (rows.size() == 0 || H5Dwrite(set, memory_type<Scalar>(), H5S_ALL,
                                                         H5S_ALL, H5P_DEFAULT, rows.data()) >= 0));
  }

  void attribute(const char* name, double value) {
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(file_, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose);
    check(attribute.is_open() && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0);
  }

  /// The bytes of the whole file.
  std::string bytes() {
    check(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0);
    const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
    check(size > 0);
    std::string image(static_cast<std::size_t>(size), '\0');
    check(H5Fget_file_image(file_, image.data(), image.size()) == size);
    return image;
  }

 private:
  /// HDF5 cannot close a file that a full disk has cut short, and crashes when the program ends: it
  /// never writes to the disk itself.
  static hid_t in_memory() {
    constexpr std::size_t kGrowth = 1 << 20;
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_fapl_core(access, kGrowth, false);
    return access;
  }

  void check(bool done) const {
    if (!done) throw OutputError(target_, "cannot be written: HDF5 fails; is there memory left?");
  }

  std::string target_;
  Handle access_;
  Handle file_;
  Handle creation_;
};

/// Deflate, the strongest filter of HDF5, shrinks data by no more than this.
constexpr hsize_t kStrongestCompression = 1032;

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path)
      : path_(path.string()), file_(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose) {
    if (!file_.is_open()) fail("is not an HDF5 file, or is truncated");
  }

  [[noreturn]] void fail(const std::string& message) const { throw IoError(path_, message); }

  bool has(const std::string& name) const {
    return H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
  }

  template <typename Scalar>
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> read(
      const std::string& name) const {
    const Handle set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose);
    if (!set.is_open()) fail("has no dataset '" + name + "'");
    const Handle space(H5Dget_space(set), H5Sclose);
    const int dimensions = space.is_open() ? H5Sget_simple_extent_ndims(space) : -1;
    hsize_t sizes[2] = {0, 1};
    if (dimensions < 1 || dimensions > 2 || H5Sget_simple_extent_dims(space, sizes, nullptr) < 0) {
      fail("dataset '" + name + "' is no matrix");
    }
    check_size(name, set, sizes[0], sizes[1]);
    Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values(
        static_cast<Eigen::Index>(sizes[0]), static_cast<Eigen::Index>(sizes[1]));
    if (values.size() > 0 &&
        H5Dread(set, memory_type<Scalar>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
      fail("dataset '" + name + "' cannot be read; the file is truncated or damaged");
    }
    if constexpr (std::is_floating_point_v<Scalar>) {
      if (!values.allFinite()) fail("dataset '" + name + "' holds a number that is not finite");
    }
    return values;
  }

  bool has_attribute(const char* name) const { return H5Aexists(file_, name) > 0; }

  double attribute(const char* name, double otherwise) const {
    if (!has_attribute(name)) return otherwise;
    const Handle attribute(H5Aopen(file_, name, H5P_DEFAULT), H5Aclose);
    const Handle space(H5Aget_space(attribute), H5Sclose);
    double value = otherwise;
    // HDF5 writes as many numbers as the attribute has: more than one would not fit.
    if (H5Sget_simple_extent_npoints(space) != 1 ||
        H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0 || !std::isfinite(value)) {
      fail(std::string("attribute '") + name + "' is not one finite number");
    }
    return value;
  }

  int whole_attribute(const char* name, int otherwise) const {
    const double value = attribute(name, otherwise);
    if (value < 0 || value > std::numeric_limits<int>::max() || value != std::floor(value)) {
      fail(std::string("attribute '") + name + "' is not a count");
    }
    return static_cast<int>(value);
  }

 private:
  /// A damaged header must not ask for more memory than the file's own bytes could fill.
  void check_size(const std::string& name, hid_t set, hsize_t rows, hsize_t columns) const {
    const hsize_t bytes = std::filesystem::file_size(path_);
    const Handle creation(H5Dget_create_plist(set), H5Pclose);
    const bool compressed = creation.is_open() && H5Pget_nfilters(creation) > 0;
    const hsize_t most = compressed ? kStrongestCompression * bytes : bytes;
    if (columns > 0 && rows > most / columns) {
      fail("dataset '" + name + "' claims more numbers than the file holds");
    }
  }

  std::string path_;
  Handle file_;
};

template <typename Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, 1> column_of(const std::vector<Scalar>& values) {
  return Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>(
      values.data(), static_cast<Eigen::Index>(values.size()));
}

void write_options(Writer& writer, const Components& components) {
  const DecompositionOptions& options = components.options;
  writer.attribute("scale", components.scale);
  writer.attribute("d_min", components.d_min);
  writer.attribute("d_max", components.d_max);
  writer.attribute("sparsity", options.sparsity);
  writer.attribute("rho", options.rho);
  if (options.iterations) writer.attribute("iterations", *options.iterations);
  writer.attribute("admm_iterations", options.admm_iterations);
  writer.attribute("tolerance", options.tolerance);
  writer.attribute("nonnegative", options.nonnegative);
  writer.attribute("single_precision", options.precision == IterationPrecision::single_precision);
  writer.attribute("basis_tolerance", options.basis_tolerance);
  writer.attribute("literal_sign_rule", options.sign_rule == SignRule::literal);
  writer.attribute("standard_deviation", options.scale == MotionScale::standard_deviation);
  writer.attribute("last_iterate", options.returned == ReturnedIterate::last);
}

void write_convergence(Writer& writer, const Components& components) {
  if (components.iteration > 0) writer.attribute("iteration", components.iteration);
  if (components.converged) writer.attribute("converged", *components.converged);
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

/// Older files and those of the reference say nothing of it.
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

/// The vertex that each component moves most; -1 where it moves none.
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
    const RowMatrix shape = reader.read<double>(component_name(k));
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
    // Exact displacements: rest + component - rest has lost their last digits.
    components.displacements = reader.read<double>("C");
    if (components.displacements.rows() != count ||
        components.displacements.cols() != 3 * vertices) {
      reader.fail("'C' does not fit the components");
    }
  }
  if (reader.has("W")) components.weights = reader.read<double>("W");
  if (reader.has("support")) components.support = reader.read<double>("support");
  if (components.support.size() > 0 &&
      (components.support.rows() != count || components.support.cols() != vertices)) {
    reader.fail("'support' does not fit the components");
  }
  if (reader.has("energies")) {
    const RowMatrix energies = reader.read<double>("energies");
    components.energies.assign(energies.data(), energies.data() + energies.size());
  }
  components.centers = strongest_vertices(components.displacements);
  if (reader.has("centers")) {
    const auto centers = reader.read<int>("centers");
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

void write_components(const std::filesystem::path& path, const Components& components,
                      bool overwrite) {
  const QuietErrors quiet;
  PendingOutput pending(path, PendingOutput::Kind::file, overwrite);
  {
    Writer writer(pending.path(), path);
    writer.write("default", components.rest);
    writer.write("tris", components.triangles);
    for (int k = 0; k < components.count(); ++k) {
      const PositionsView field(components.displacements.row(k).data(), components.vertices(), 3);
      writer.write(component_name(k), Positions(components.rest + field));
    }
    writer.write("C", components.displacements);
    if (components.weights.size() > 0) writer.write("W", components.weights);
    if (components.support.size() > 0) writer.write("support", components.support);
    if (!components.centers.empty()) writer.write("centers", column_of(components.centers));
    if (!components.energies.empty()) writer.write("energies", column_of(components.energies));
    write_options(writer, components);
    write_convergence(writer, components);
    write_bytes(pending.path(), writer.bytes());
  }
  pending.commit();
}

Components read_components(const std::filesystem::path& path) {
  std::error_code unreadable;
  const auto status = std::filesystem::status(path, unreadable);
  if (!std::filesystem::exists(status)) throw IoError(path.string(), "no such file");
  if (std::filesystem::is_directory(status)) {
    throw IoError(path.string(), "is a folder, expected a file of components");
  }
  const QuietErrors quiet;
  const Reader reader(path);
  Components components;
  const RowMatrix rest = reader.read<double>("default");
  const auto triangles = reader.read<int>("tris");
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
