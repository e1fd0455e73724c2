#pragma once

/// Adds the operations of mimetra's plugins to ParaView, which knows them only at run time.
/// Operations that begin with a mesh over time become filters in the menu mimetra.
void add_third_party_operations();
