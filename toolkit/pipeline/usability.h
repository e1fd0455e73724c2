#pragma once

/// From where on people see that a result is wrong. Internal to what notes it.
namespace mimetra {

/// Sound results miss 0.1 to 4 % of the deformation and flip 1 to 5 triangles of 100 000; results
/// that people see to be wrong, 8 % and more, or 40 and more.
constexpr double kUnusableMissedShare = 0.08;
constexpr double kUnusableFlippedShare = 2e-4;

}  // namespace mimetra
