// Defines the only symbol of libmimetra_pictures: the operations of libmimetra_c, and those that
// draw.

#include "plugins/c/interface.h"
#include "plugins/c/plugins.h"
#include "samples/head/sample_operation.h"
#include "toolkit/pictures/picture_formats.h"
#include "toolkit/report/report_operation.h"
#include "toolkit/vtk/vtk_formats.h"

#ifdef MIMETRA_HAS_FITTING
#include "fitting/fit_operation.h"
#endif

namespace {

mimetra_status new_context(mimetra_log log, void* user, mimetra_context** context) noexcept {
  return mimetra::make_context(
      [](mimetra::OperationTable& table) {
        mimetra::add_toolkit(table);
        mimetra::add_vtk(table);
        mimetra::add_pictures(table);
        mimetra::add_report(table);
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
  return mimetra::library_interface(version, new_context);
}
