#pragma once

namespace mimetra {

/// Silences VTK's error output, in all threads, as long as an instance exists. mimetra throws
/// errors instead.
class SilentVtk {
 public:
  SilentVtk();
  ~SilentVtk();
  SilentVtk(const SilentVtk&) = delete;
  SilentVtk& operator=(const SilentVtk&) = delete;
};

}  // namespace mimetra
