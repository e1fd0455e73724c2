#pragma once

#include <memory>
#include <string>

#include "plugins/c/described_table.h"
#include "plugins/c/mimetra.h"
#include "toolkit/operations/operation.h"

namespace mimetra {

/// A function of a plugin, ready to be run as an operation.
struct PluginFunction {
  mimetra_run run;
  void* user;
  /// In messages: "the plugin: the operation".
  std::string subject;
  /// What its runs may call.
  std::shared_ptr<const DescribedTable> toolkit;

  /// Runs it as `operation`. What it does wrong ends the run with an exception that names it, and
  /// changes nothing else.
  Outcome operator()(const Operation& operation, const Invocation& invocation) const;
};

}  // namespace mimetra
