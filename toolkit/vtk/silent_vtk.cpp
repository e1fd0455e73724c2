#include "toolkit/vtk/silent_vtk.h"

#include <vtkObject.h>

namespace mimetra {

SilentVtk::SilentVtk() : before_(vtkObject::GetGlobalWarningDisplay()) {
  vtkObject::GlobalWarningDisplayOff();
}

SilentVtk::~SilentVtk() {
  vtkObject::SetGlobalWarningDisplay(before_);
}

}  // namespace mimetra
