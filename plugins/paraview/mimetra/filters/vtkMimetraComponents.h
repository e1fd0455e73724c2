#pragma once

#include "plugins/paraview/mimetra/filters/vtkMimetraFilter.h"

/// Sparse components as blocks, each at weight 1, and their weights over time. This needs a class
/// of its own because components are neither a sequence nor fields: the class makes the blocks.
class MIMETRAFILTERS_EXPORT vtkMimetraComponents : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraComponents, vtkMimetraFilter);
  static vtkMimetraComponents* New();

  /// Sets whether blocks are in rows beside each other, or all at the mesh.
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
