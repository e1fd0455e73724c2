#pragma once

#include <vector>

#include <vtkNew.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraAlgorithm.h"

/// Reads a sequence or model of any format, with its times. On a server of several processes, the
/// first one reads the file and has the mesh; the others know only the times.
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
  /// Reads the file. Returns its times, or none for a single frame.
  std::vector<double> read();
  /// Collective. The first process reads, and all learn the times.
  void read_by_first();

  vtkNew<vtkPolyData> mesh_;  ///< shared by all frames
  std::vector<double> times_;
  vtkMTimeType read_at_ = 0;
};
