#pragma once

/// Adds to ParaView the operations of mimetra's plugins, which it knows only when it runs: those
/// that begin with a mesh over time, as filters in the menu mimetra.
void add_third_party_operations();
