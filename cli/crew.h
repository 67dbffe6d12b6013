#pragma once

#include <functional>

#include "transport/render/crew.h"

namespace abbe::cli {

/// What the module for MPI offers, which is loaded under mpirun only.
struct CrewModule {
  Crew crew;
  void (*abandon)(int code);  ///< Ends all processes.
};
/// The name under which the module exports a function that returns a `const CrewModule*`.
inline constexpr const char* kCrewSymbol = "abbe_mpi";

/// The processes that mpirun started with this one; alone where it was not mpirun that did. The first call
/// loads the module and joins the others; throws Error{input} when there is no module.
[[nodiscard]] const Crew& crew();

/// Ends the others too where a process of a crew fails: they would wait for it for ever.
void abandon_crew(int code);

/// While it lives, a process that does not lead tells nothing: the first does.
class LeaderTells {
 public:
  explicit LeaderTells(const Crew& crew);
  ~LeaderTells();
  LeaderTells(const LeaderTells&) = delete;
  LeaderTells& operator=(const LeaderTells&) = delete;

 private:
  int stream_ = -1;  // standard error, kept for later
};

}  // namespace abbe::cli
