#pragma once

namespace mimetra {

/// VTK prints its errors; what goes wrong is thrown instead. Silent as long as it lives.
class SilentVtk {
 public:
  SilentVtk();
  ~SilentVtk();
  SilentVtk(const SilentVtk&) = delete;
  SilentVtk& operator=(const SilentVtk&) = delete;

 private:
  int before_;
};

}  // namespace mimetra
