#pragma once

#include <vtkNew.h>

#include "plugins/paraview/mimetra/filters/vtkMimetraAlgorithm.h"

/// Reads a sequence or model of any format, with its times.
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
  void read();

  vtkNew<vtkPolyData> mesh_;  ///< what all frames share
  vtkMTimeType read_at_ = 0;
};
