#pragma once

#include <memory>

#include "toolkit/operations/data.h"

class vtkRenderWindow;

namespace mimetra {

/// A window of VTK that nobody sees and that needs no display: it draws with OpenGL on an EGL
/// context without a surface (Mesa does so on any processor).
class OffscreenWindow {
 public:
  /// Throws std::runtime_error where EGL offers none.
  OffscreenWindow(int width, int height);
  ~OffscreenWindow();
  OffscreenWindow(const OffscreenWindow&) = delete;
  OffscreenWindow& operator=(const OffscreenWindow&) = delete;

  vtkRenderWindow& window() const;
  /// Draws what the window holds. Throws std::runtime_error where OpenGL has not enough memory.
  Image image() const;

 private:
  friend class OneWindow;
  struct State;
  std::unique_ptr<State> state_;
};

/// While it lives, the windows of its thread are one, as long as there are not two at a time.
class OneWindow {
 public:
  OneWindow();
  ~OneWindow();
  OneWindow(const OneWindow&) = delete;
  OneWindow& operator=(const OneWindow&) = delete;

 private:
  friend class OffscreenWindow;
  /// The one that is free; null before the first, and while it is in use.
  std::unique_ptr<OffscreenWindow::State> free_;
  OneWindow* outer_;
};

}  // namespace mimetra
