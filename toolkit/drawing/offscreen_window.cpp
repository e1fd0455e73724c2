#include "toolkit/drawing/offscreen_window.h"

#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include "toolkit/vtk/silent_vtk.h"

namespace mimetra {

namespace {

/// An OpenGL context without a surface. The display belongs to the process and stays open, because
/// drivers do not return all their memory when it is closed.
class EglContext {
 public:
  /// Returns null if EGL offers no context.
  static std::unique_ptr<EglContext> create() {
    auto context = std::unique_ptr<EglContext>(new EglContext);
    return context->start() ? std::move(context) : nullptr;
  }

  ~EglContext() {
    if (context_ == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context_) release();
    eglDestroyContext(display_, context_);
  }

  /// Returns false if another context is current in this thread.
  bool make_current() const {
    return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
  }

  void release() const { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

 private:
  EglContext() = default;

  /// Mesa draws without a device; other drivers offer their default display.
  bool open_display() {
    const auto display_of = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (display_of) {
      display_ = display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    }
    if (display_ != EGL_NO_DISPLAY && eglInitialize(display_, nullptr, nullptr)) return true;
    display_ = eglGetDisplay(EGL_DEFAULT_DISPLAY);
    return display_ != EGL_NO_DISPLAY && eglInitialize(display_, nullptr, nullptr);
  }

  bool start() {
    if (!open_display()) return false;
    if (!eglBindAPI(EGL_OPENGL_API)) return false;
    constexpr EGLint kConfig[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                  EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (!eglChooseConfig(display_, kConfig, &config, 1, &count) || count == 0) return false;
    // VTK needs OpenGL 3.2.
    constexpr EGLint kVersion[] = {EGL_CONTEXT_MAJOR_VERSION,
                                   3,
                                   EGL_CONTEXT_MINOR_VERSION,
                                   2,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                   EGL_NONE};
    context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, kVersion);
    return context_ != EGL_NO_CONTEXT;
  }

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

vtkSmartPointer<vtkRenderWindow> window_on_current_context() {
  const auto window = vtkSmartPointer<vtkGenericOpenGLRenderWindow>::New();
  window->SetMapped(true);
  window->SetIsCurrent(true);
  window->SetIsDirect(1);
  window->SetSupportsOpenGL(1);
  window->SetReadyForRendering(true);
  // VTK's loader complains about missing GLX after it has found every function it needs.
  const SilentVtk silent;
  window->InitializeFromCurrentContext();
  return window;
}

/// Samples for smooth edges: the maximum of Mesa's software renderer.
constexpr int kSamples = 4;

}  // namespace

struct OffscreenWindow::State {
  // The window needs the context until it is destroyed.
  std::unique_ptr<EglContext> context;
  vtkSmartPointer<vtkRenderWindow> window;

  State() : context(EglContext::create()) {
    if (!context) {
      throw std::runtime_error(
          "pictures need OpenGL 3.2 by EGL, and there is none; install libegl1 and "
          "libgl1-mesa-dri");
    }
    make_current();
    window = window_on_current_context();
    window->SetShowWindow(false);
    window->SetUseOffScreenBuffers(true);
    window->SetMultiSamples(kSamples);
  }

  ~State() {
    if (window) window->Finalize();
    window = nullptr;
  }

  void make_current() const {
    if (context->make_current()) return;
    throw std::runtime_error(
        "pictures cannot be drawn in a thread that draws into a window itself, as VTK and Qt do; "
        "call it from another thread");
  }

  /// Resets the window to the state of a new one.
  void empty() const {
    while (vtkRenderer* renderer = window->GetRenderers()->GetFirstRenderer()) {
      window->RemoveRenderer(renderer);
    }
    window->SetNumberOfLayers(1);
  }
};

namespace {

/// Innermost OneWindow of this thread.
thread_local OneWindow* one_window = nullptr;

}  // namespace

OneWindow::OneWindow() : outer_(std::exchange(one_window, this)) {}

OneWindow::~OneWindow() {
  one_window = outer_;
  if (free_) free_->context->make_current();
}

OffscreenWindow::OffscreenWindow(int width, int height) {
  if (one_window && one_window->free_) {
    one_window->free_->make_current();
    state_ = std::move(one_window->free_);
  } else {
    state_ = std::make_unique<State>();
  }
  state_->window->SetSize(width, height);
}

OffscreenWindow::~OffscreenWindow() {
  if (!one_window || one_window->free_) return;
  state_->empty();
  state_->context->release();
  one_window->free_ = std::move(state_);
}

vtkRenderWindow& OffscreenWindow::window() const {
  return *state_->window;
}

Image OffscreenWindow::image() const {
  vtkRenderWindow& window = *state_->window;
  window.Render();
  const int width = window.GetSize()[0], height = window.GetSize()[1];
  vtkNew<vtkUnsignedCharArray> pixels;
  window.GetPixelData(0, 0, width - 1, height - 1, 0, pixels);
  Image image(width, height);
  static_assert(sizeof(Color) == 3);
  const std::size_t row = 3 * static_cast<std::size_t>(width);
  if (pixels->GetNumberOfValues() < static_cast<vtkIdType>(row) * height) {
    throw std::runtime_error("OpenGL could not draw " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels; take a smaller size");
  }
  for (int y = 0; y < height; ++y) {  // OpenGL counts rows from below
    std::memcpy(&image.at(0, y), pixels->GetPointer(static_cast<vtkIdType>(row) * (height - 1 - y)),
                row);
  }
  return image;
}

}  // namespace mimetra
