#pragma once

#include <cstdint>
#include <deque>
#include <initializer_list>
#include <string>
#include <vector>

#include "plugins/c/mimetra.h"
#include "toolkit/operations/data.h"

namespace mimetra {

/// A value as named arrays, which mimetra.h lists by kind. Points into the value, which must
/// outlive it, wherever its memory is in order; holds copies of the rest.
class ShownArrays {
 public:
  explicit ShownArrays(const Data& data);
  ShownArrays(const ShownArrays&) = delete;
  ShownArrays& operator=(const ShownArrays&) = delete;

  const std::deque<mimetra_array>& arrays() const { return arrays_; }
  /// The same as a list that ends with NULL.
  const mimetra_array* const* list() const { return list_.data(); }
  /// Null where there is none of that name.
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
  /// As pictures draw each region, by the field that says which is the strongest.
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

}  // namespace mimetra
