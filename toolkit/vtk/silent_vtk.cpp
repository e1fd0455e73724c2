#include "toolkit/vtk/silent_vtk.h"

#include <mutex>

#include <vtkObject.h>

namespace mimetra {

namespace {

std::mutex changing;
int living = 0;
int before = 0;

}  // namespace

SilentVtk::SilentVtk() {
  const std::lock_guard lock(changing);
  if (living++ > 0) return;
  before = vtkObject::GetGlobalWarningDisplay();
  vtkObject::GlobalWarningDisplayOff();
}

SilentVtk::~SilentVtk() {
  const std::lock_guard lock(changing);
  if (--living == 0) vtkObject::SetGlobalWarningDisplay(before);
}

}  // namespace mimetra
