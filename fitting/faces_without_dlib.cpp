#include "fitting/face_finder.h"
#include "toolkit/mesh/errors.h"

/// Errors of a build without dlib when images are used.
namespace mimetra {

namespace {

constexpr const char* kMissing =
    "images need dlib, without which mimetra was built; install the packages libdlib-dev and "
    "libdlib-data and build again, or give landmarks as .pts, CSV or JSON";

}  // namespace

struct FaceFinder::State {};

FaceFinder::FaceFinder(const std::filesystem::path& model) {
  throw IoError(model.string(), kMissing);
}
FaceFinder::~FaceFinder() = default;
FaceFinder::FaceFinder(FaceFinder&&) noexcept = default;
FaceFinder& FaceFinder::operator=(FaceFinder&&) noexcept = default;

std::vector<Face> FaceFinder::faces(const Image&) const {
  return {};
}

std::vector<Face> FaceFinder::faces_near(const Image&, const std::vector<Face>&) const {
  return {};
}

bool faces_can_be_found() {
  return false;
}

void require_dlib(const std::string& name) {
  throw IoError(name, kMissing);
}

}  // namespace mimetra
