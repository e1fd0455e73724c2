// The one symbol of libmimetra_c, and of libmimetra_pictures, which draws too.

#include "plugins/c/interface.h"
#include "plugins/c/plugins.h"
#include "samples/head/sample_operation.h"

#ifdef MIMETRA_HAS_FITTING
#include "fitting/fit_operation.h"
#endif
#ifdef MIMETRA_HAS_VTK
#include "toolkit/pictures/picture_formats.h"
#include "toolkit/report/report_operation.h"
#include "toolkit/vtk/vtk_formats.h"
#endif

namespace {

mimetra_status new_context(mimetra_log log, void* user, mimetra_context** context) noexcept {
  return mimetra::make_context(
      [](mimetra::OperationTable& table) {
        mimetra::add_toolkit(table);
#ifdef MIMETRA_HAS_VTK
        mimetra::add_vtk(table);
        mimetra::add_pictures(table);
        mimetra::add_report(table);
#endif
#ifdef MIMETRA_HAS_FITTING
        mimetra::add_fitting(table);
#endif
        mimetra::samples::add_sample(table);
        return mimetra::add_plugins(table, mimetra::plugin_folders());
      },
      log, user, context);
}

}  // namespace

const mimetra_interface* mimetra_get_interface(uint32_t version) {
  static const mimetra_interface functions = [] {
    mimetra_interface all = mimetra::toolkit_interface();
    all.new_context = new_context;
    return all;
  }();
  return version == MIMETRA_INTERFACE_VERSION ? &functions : nullptr;
}
