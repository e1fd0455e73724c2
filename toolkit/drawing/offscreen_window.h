#pragma once

#include <memory>

#include "toolkit/io/data.h"

class vtkRenderWindow;

namespace mimetra {

/// A hidden VTK window that needs no display. It draws with OpenGL on an EGL context without a
/// surface (Mesa does so on any processor).
class OffscreenWindow {
 public:
  /// Throws std::runtime_error if EGL offers no such context.
  OffscreenWindow(int width, int height);
  ~OffscreenWindow();
  OffscreenWindow(const OffscreenWindow&) = delete;
  OffscreenWindow& operator=(const OffscreenWindow&) = delete;

  vtkRenderWindow& window() const;
  /// Draws the contents of the window. Throws std::runtime_error if OpenGL has not enough memory.
  Image image() const;

 private:
  friend class OneWindow;
  struct State;
  std::unique_ptr<State> state_;
};

/// While it lives, windows of its thread reuse one window, as long as there is only one at a time.
class OneWindow {
 public:
  OneWindow();
  ~OneWindow();
  OneWindow(const OneWindow&) = delete;
  OneWindow& operator=(const OneWindow&) = delete;

 private:
  friend class OffscreenWindow;
  /// The free window; null before the first, and while the window is in use.
  std::unique_ptr<OffscreenWindow::State> free_;
  OneWindow* outer_;
};

}  // namespace mimetra
