#include "toolkit/vtk/silent_vtk.h"

#include <mutex>

#include <vtkObject.h>

namespace mimetra {

namespace {

/// State of the whole process.
struct Silence {
  std::mutex changing;
  int living = 0;
  int before = 0;
} silence;

}  // namespace

SilentVtk::SilentVtk() {
  const std::lock_guard lock(silence.changing);
  if (silence.living++ > 0) return;
  silence.before = vtkObject::GetGlobalWarningDisplay();
  vtkObject::GlobalWarningDisplayOff();
}

SilentVtk::~SilentVtk() {
  const std::lock_guard lock(silence.changing);
  if (--silence.living == 0) vtkObject::SetGlobalWarningDisplay(silence.before);
}

}  // namespace mimetra
