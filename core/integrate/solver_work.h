#pragma once

namespace tribodyn {

/// What solvers did.
struct SolverWork {
  long right_hand_sides = 0;
  long contact_solutions = 0;
  long accepted_steps = 0;
  long rejected_steps = 0;
  long events = 0;       ///< exact locations of contact loss, regain and load onset
  long mesh_cycles = 0;  ///< integrated in all, under frozen friction or with friction in the loop

  SolverWork& operator+=(const SolverWork& more) {
    right_hand_sides += more.right_hand_sides;
    contact_solutions += more.contact_solutions;
    accepted_steps += more.accepted_steps;
    rejected_steps += more.rejected_steps;
    events += more.events;
    mesh_cycles += more.mesh_cycles;
    return *this;
  }
};

}  // namespace tribodyn
