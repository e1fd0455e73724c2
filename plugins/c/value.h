#pragma once

#include <cstdint>
#include <deque>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "plugins/c/context_handle.h"
#include "plugins/c/mimetra.h"
#include "toolkit/io/data.h"

namespace mimetra {

/// A value as named arrays, which mimetra.h lists for each kind. Points into the value, which must
/// outlive it, if the memory layout matches, and copies the rest.
class ShownArrays {
 public:
  explicit ShownArrays(const Data& data);
  ShownArrays(const ShownArrays&) = delete;
  ShownArrays& operator=(const ShownArrays&) = delete;

  const std::deque<mimetra_array>& arrays() const { return arrays_; }
  /// The same arrays as a list that ends with NULL.
  const mimetra_array* const* list() const { return list_.data(); }
  /// Null if no array has that name.
  const mimetra_array* find(const std::string& name) const;

 private:
  using Shape = std::initializer_list<Eigen::Index>;

  void show_triangles(const Triangles& triangles);
  void show(const ModelData& data);
  void show(const Components& components);
  void show(const RegionData& data);
  void show(const FieldSequence& fields);
  void show(const Table& table);
  void show(const LandmarkTrack& track);
  void show(const FittedCoefficients& fit);
  void show(const Pictures& pictures);
  void show(const Document& document);
  void show(const MeshSequence& sequence);
  void show(const Connectivity& faces);
  void show(const Field& field);
  /// Colours of the regions, as in pictures, from the field with the strongest region.
  void show_colors(const Field& strongest, const Regions& regions, const Triangles& triangles);
  void show_basis(const ShapeBasis& basis, const char* shapes, const char* names);

  void add(const char* name, int type, Shape shape, const void* values,
           int location = MIMETRA_NOWHERE);
  void add_numbers(const char* name, Shape shape, std::vector<double> values,
                   int location = MIMETRA_NOWHERE);
  void add_integers(const char* name, Shape shape, std::vector<std::int32_t> values,
                    int location = MIMETRA_NOWHERE);
  void add_bytes(const char* name, Shape shape, std::vector<std::uint8_t> values);
  void add_strings(const char* name, const std::vector<std::string>& texts);
  void add_vector(const char* name, const Eigen::VectorXd& values);

  std::deque<mimetra_array> arrays_;
  std::vector<const mimetra_array*> list_;
  std::deque<std::vector<double>> numbers_;
  std::deque<std::vector<std::int32_t>> integers_;
  std::deque<std::vector<std::uint8_t>> bytes_;
  std::deque<std::vector<const char*>> strings_;
  std::deque<std::string> names_;
  std::deque<std::vector<std::string>> texts_;
  std::deque<Image> images_;
};

/// An immutable value. Its arrays and its JSON are made on demand.
class Value {
 public:
  explicit Value(NamedData named) : named_(std::move(named)) {}

  const NamedData& named() const { return named_; }
  mimetra_kind kind() const {
    return static_cast<mimetra_kind>(named_.data.index()) + MIMETRA_SEQUENCE;
  }
  /// Thread-safe.
  const ShownArrays& arrays() const;
  /// Contents of the file for regions, tables and fits; a list of the arrays for other kinds.
  const std::string& json() const;

 private:
  NamedData named_;
  mutable std::mutex mutex_;
  mutable std::optional<ShownArrays> arrays_;
  mutable std::optional<std::string> json_;
};

/// Reads a value from a file. `settings` are parameters of reading that kind, "NAME=VALUE", and end
/// with NULL. Throws UsageError for a bad setting, and as the readers throw.
NamedData loaded_data(const mimetra_context& context, DataKind kind, const std::string& text,
                      const char* const* settings);

/// Writes a value. `settings` are parameters of writing its kind, and "force=true". Throws
/// UsageError for a bad setting or an extension without a writer, and as the writers throw.
void write_data(const mimetra_context& context, const Data& data, const std::string& path,
                const char* const* settings);

}  // namespace mimetra

/// Handle to a value. Any number of handles can share one.
struct mimetra_data {
  std::shared_ptr<const mimetra::Value> value;
};
