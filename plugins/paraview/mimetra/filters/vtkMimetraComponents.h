#pragma once

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Sparse components, each a block that shows it at weight 1, and their weights over time. A class
/// of its own because components are neither a sequence nor fields: what shows them is made here.
class MIMETRAFILTERS_EXPORT vtkMimetraComponents : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraComponents, vtkMimetraFilter);
  static vtkMimetraComponents* New();

  /// Whether blocks stand in rows beside each other, or all where the mesh is.
  void SetSideBySide(int on);

 protected:
  vtkMimetraComponents();
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  bool moves(int port) const override;
  std::vector<std::string> wanted_outputs(const mimetra::Invocation& invocation) override;
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, double time,
            vtkInformationVector* outputs) override;

 private:
  bool side_by_side_ = true;
};
