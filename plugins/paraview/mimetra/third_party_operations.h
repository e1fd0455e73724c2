#pragma once

/// Adds to ParaView the operations of mimetra's plugins, which it knows only when it runs: those
/// that make a sequence or fields of the input's, as filters in the menu mimetra.
void add_third_party_operations();
