#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "toolkit/io/hdf5_fields.h"

/// HDF5 files, read without HDF5's library: that one crashes on damaged files, follows what a file
/// says into other files, and loads plugins. Here nothing but the file itself is read, and every
/// address, size and count is checked against it first. What is read are numbers at the top of a
/// file, as HDF5 and h5py store them unless they are asked for their latest format. Internal to the
/// readers of formats that are HDF5.
///
/// [The HDF Group. HDF5 File Format Specification, version 3.0]
namespace mimetra {

/// An array of numbers in a file, of which parts are read.
class Hdf5Dataset {
 public:
  /// Throws IoError for what is no array of numbers, is stored anywhere but in the file, by means
  /// of other filters than those of HDF5 itself, or claims more than the file can hold.
  Hdf5Dataset(std::shared_ptr<const Hdf5Bytes> file, std::string name,
              const std::vector<Hdf5Message>& messages);

  const std::vector<std::uint64_t>& shape() const { return shape_; }
  const Hdf5Type& type() const { return type_; }
  /// Numbers for each index of the first dimension, and in all.
  std::uint64_t row_size() const { return row_size_; }
  std::uint64_t size() const { return size_; }

  /// Rows of the first dimension from `first` on, as many as `values` has place for. From several
  /// threads. Throws IoError for damaged content. \pre they are there
  void read(std::uint64_t first, std::span<double> values) const;
  /// All of them, in C order.
  std::vector<double> values() const;

  /// Throws IoError that names the dataset.
  [[noreturn]] void fail(const std::string& message) const;

  /// Where the bytes of rows are.
  class Storage {
   public:
    virtual ~Storage() = default;
    virtual void read_rows(std::uint64_t first, std::uint64_t rows, char* to) const = 0;
  };

 private:
  std::shared_ptr<const Hdf5Bytes> file_;
  std::string name_;
  std::vector<std::uint64_t> shape_;
  Hdf5Type type_;
  std::uint64_t row_size_ = 1;
  std::uint64_t size_ = 1;
  std::shared_ptr<const Storage> storage_;
};

/// The top of an HDF5 file.
class Hdf5File {
 public:
  /// Throws IoError for what is missing, a folder, no HDF5 file, truncated or damaged.
  explicit Hdf5File(const std::filesystem::path& path);

  const std::string& path() const { return bytes_->path(); }
  /// Of the top group, in order.
  std::vector<std::string> names() const;
  bool has(const std::string& name) const { return links_.contains(name); }
  /// Throws IoError; also for a link to elsewhere, which is not followed.
  Hdf5Dataset dataset(const std::string& name) const;

  bool has_attribute(const std::string& name) const { return attributes_.contains(name); }
  /// One finite number; `otherwise` where there is none. Throws IoError for anything else.
  double attribute(const std::string& name, double otherwise) const;

  /// Throws IoError.
  [[noreturn]] void fail(const std::string& message) const { bytes_->fail(message); }

 private:
  void add_attribute(const Hdf5Message& message);

  std::shared_ptr<const Hdf5Bytes> bytes_;
  /// Where each object's header is; none for links to elsewhere.
  std::map<std::string, std::optional<std::uint64_t>> links_;
  /// None for what is not one number.
  std::map<std::string, std::optional<double>> attributes_;
};

}  // namespace mimetra
