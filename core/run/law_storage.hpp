// Storage of the control laws that work in some.
#pragma once

#include "core/run/muscle_law.hpp"
#include "core/run/reduced_basis.hpp"

namespace hagfish {

/// What it holds does not matter from one step to the next, so that copies begin empty.
struct LawStorage {
  LawStorage() = default;
  LawStorage(const LawStorage& /*other*/) : LawStorage() {}
  // NOLINTNEXTLINE(cert-oop54-cpp): nothing is assigned
  LawStorage& operator=(const LawStorage& /*other*/) { return *this; }

  ReducedBasisStorage reduced_basis;
  MuscleStorage muscles;
};

}  // namespace hagfish
