#pragma once

#include <vector>

#include <vtkNew.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraAlgorithm.h"

/// Reads a sequence or model of any format, with its times. On a server of several processes the
/// first one reads it, and has the mesh; the others know the times.
class MIMETRAFILTERS_EXPORT vtkMimetraSequence : public vtkMimetraAlgorithm {
 public:
  vtkTypeMacro(vtkMimetraSequence, vtkMimetraAlgorithm);
  static vtkMimetraSequence* New();

 protected:
  vtkMimetraSequence();

  int RequestInformation(vtkInformation* request, vtkInformationVector** inputs,
                         vtkInformationVector* outputs) override;
  int RequestData(vtkInformation* request, vtkInformationVector** inputs,
                  vtkInformationVector* outputs) override;

 private:
  /// Returns its times, none where it stands still.
  std::vector<double> read();
  /// By all processes: the first one reads, all know its times.
  void read_by_first();

  vtkNew<vtkPolyData> mesh_;  ///< what all frames share
  std::vector<double> times_;
  vtkMTimeType read_at_ = 0;
};
