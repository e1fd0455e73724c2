#pragma once

#include "vtkMimetraFilter.h"

/// An operation of a plugin: the sequence or the fields that it makes of its input's.
class MIMETRAFILTERS_EXPORT vtkMimetraOperation : public vtkMimetraFilter {
 public:
  vtkTypeMacro(vtkMimetraOperation, vtkMimetraFilter);
  static vtkMimetraOperation* New();

  /// Which one it is, set before anything else.
  void SetOperation(const char* name);

 protected:
  vtkMimetraOperation();
  void show(const mimetra::Outcome& outcome, vtkPolyData& input, int frame,
            vtkInformationVector* outputs) override;
};
