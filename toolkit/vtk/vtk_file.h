#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "toolkit/mesh/fields.h"
#include "toolkit/vtk/vtk_layout.h"

class vtkPolyData;
template <typename>
class vtkSmartPointer;

namespace mimetra {

/// Extensions of files with one surface: .vtp, .vtu and legacy .vtk.
const std::vector<std::string>& vtk_extensions();

/// One surface in a file of VTK. The constructor reads the file and finds its arrays; queries
/// decode them. VTK's own readers are not used: they fail on appended data with a current libexpat,
/// and expand entities.
///
/// An unstructured grid must hold triangles, quads, polygons and pixels; vertices and lines in it
/// are left out. All queries throw IoError that begins with the path.
class VtkFile {
 public:
  /// Throws IoError.
  explicit VtkFile(const std::filesystem::path& path);
  VtkFile(const VtkFile&) = delete;
  VtkFile& operator=(const VtkFile&) = delete;

  const std::string& path() const { return path_; }

  /// Points without faces and fields.
  vtkSmartPointer<vtkPolyData> points() const;
  /// The surface with all fields, or with those whose name `is_wanted`.
  vtkSmartPointer<vtkPolyData> poly_data(
      const std::function<bool(const std::string& name)>& is_wanted = {}) const;

  struct StoredField {
    Field::Location location;
    std::string name;

    bool operator==(const StoredField&) const = default;
  };
  std::vector<StoredField> stored_fields() const;

  /// Whether the files have equal bytes for all cells, or for all cells and a field. If so, the
  /// values are equal, too.
  bool stores_cells_of(const VtkFile& other) const;
  bool stores_field_of(const VtkFile& other, const StoredField& field) const;

 private:
  vtkSmartPointer<vtkPolyData> piece(
      const VtkPiece& piece, bool points_only,
      const std::function<bool(const std::string&)>& is_wanted) const;

  std::string path_;
  std::string text_;  ///< never changed: the layout refers to it
  VtkLayout layout_;
};

}  // namespace mimetra
