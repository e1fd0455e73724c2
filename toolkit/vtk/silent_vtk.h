#pragma once

namespace mimetra {

/// VTK prints its errors; what goes wrong is thrown instead. It is silent, in all threads, as long
/// as one of these lives.
class SilentVtk {
 public:
  SilentVtk();
  ~SilentVtk();
  SilentVtk(const SilentVtk&) = delete;
  SilentVtk& operator=(const SilentVtk&) = delete;
};

}  // namespace mimetra
