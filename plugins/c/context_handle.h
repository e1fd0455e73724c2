#pragma once

#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "plugins/c/described_table.h"
#include "plugins/c/failure.h"
#include "plugins/c/mimetra.h"
#include "toolkit/mesh/context.h"
#include "toolkit/operations/operation.h"

struct mimetra_context {
  std::shared_ptr<const mimetra::DescribedTable> table;
  mimetra::Log log = {};
  mimetra::Context context = {};
  std::string message = {};

  mimetra_status fail(const std::exception_ptr& error) noexcept {
    try {
      mimetra::Failure failure = mimetra::failure_of(error);
      message = std::move(failure.message);
      return failure.status;
    } catch (...) {
      message.clear();  // there is no memory for one
      return MIMETRA_FAILED;
    }
  }
};

namespace mimetra {

/// Runs a function of the interface: what it throws becomes status and message.
template <typename Work>
mimetra_status guarded(mimetra_context* context, Work&& work) noexcept {
  if (!context) return MIMETRA_USAGE;
  try {
    work();
    return MIMETRA_OK;
  } catch (...) {
    return context->fail(std::current_exception());
  }
}

/// Throws UsageError for NULL. Returns what it is given.
template <typename Argument>
Argument* needed(Argument* argument, const char* name) {
  if (!argument) throw UsageError(std::string("the argument '") + name + "' is NULL");
  return argument;
}

}  // namespace mimetra
