#pragma once

#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>

/// Files made and read by HDF5's own library.
namespace mimetra::test {

/// A file that is being made; it is whole when this goes.
class Hdf5Made {
 public:
  using Change = std::function<void(hid_t)>;
  using Sizes = std::vector<hsize_t>;

  explicit Hdf5Made(const std::filesystem::path& path, bool latest = false) {
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (latest) H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
    file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    H5Pclose(access);
    EXPECT_GE(file_, 0);
  }
  ~Hdf5Made() { EXPECT_GE(H5Fclose(file_), 0); }
  Hdf5Made(const Hdf5Made&) = delete;
  Hdf5Made& operator=(const Hdf5Made&) = delete;

  hid_t id() const { return file_; }

  /// Numbers of a stored type; `change` sets how. Without values nothing is written. `most` are the
  /// sizes that the dataset may be extended to, if these are others.
  void add(const std::string& name, const Sizes& sizes, const std::vector<double>& values,
           hid_t stored = H5T_IEEE_F64LE, const Change& change = {}, const Sizes& most = {}) const {
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    if (change) change(creation);
    const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(),
                                         most.empty() ? nullptr : most.data());
    const hid_t set =
        H5Dcreate2(file_, name.c_str(), stored, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    EXPECT_GE(set, 0) << name;
    if (!values.empty()) {
      EXPECT_GE(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    }
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(creation);
  }

  /// Changes the sizes of a dataset.
  void resize(const std::string& name, const Sizes& sizes) const {
    const hid_t set = H5Dopen2(file_, name.c_str(), H5P_DEFAULT);
    EXPECT_GE(H5Dset_extent(set, sizes.data()), 0) << name;
    H5Dclose(set);
  }

 private:
  hid_t file_;
};

/// In blocks of these sizes.
inline Hdf5Made::Change in_chunks(Hdf5Made::Sizes sizes, Hdf5Made::Change also = {}) {
  return [sizes = std::move(sizes), also = std::move(also)](hid_t creation) {
    H5Pset_chunk(creation, static_cast<int>(sizes.size()), sizes.data());
    if (also) also(creation);
  };
}

/// 0, 1, 2 ... as many as `sizes` need.
inline std::vector<double> counted_up(const Hdf5Made::Sizes& sizes) {
  std::vector<double> values(
      std::accumulate(sizes.begin(), sizes.end(), std::size_t{1}, std::multiplies<>()));
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

/// All numbers of a dataset as the library reads them.
inline std::vector<double> library_values(const std::filesystem::path& path,
                                          const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GE(file, 0) << path;
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  EXPECT_GE(set, 0) << name;
  const hid_t space = H5Dget_space(set);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  if (!values.empty()) {
    EXPECT_GE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  }
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return values;
}

/// The sizes of a dataset as the library reads them.
inline Hdf5Made::Sizes library_shape(const std::filesystem::path& path, const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  EXPECT_GE(set, 0) << name;
  const hid_t space = H5Dget_space(set);
  Hdf5Made::Sizes sizes(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, sizes.data(), nullptr);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return sizes;
}

}  // namespace mimetra::test
