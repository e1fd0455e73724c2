// The one symbol of libmimetra_c.

#include <mimetra/c/interface.h>
#include <mimetra/c/plugins.h>
#include <mimetra/fitting/fit_operation.h>
#include <mimetra/samples/sample_operation.h>

namespace {

mimetra_status new_context(mimetra_log log, void* user, mimetra_context** context) noexcept {
  return mimetra::make_context(
      [](mimetra::OperationTable& table) {
        mimetra::add_toolkit(table);
        mimetra::add_fitting(table);
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
