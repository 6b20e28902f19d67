// States of the Table 1 run with what another simulator can be held against in each of them.
#pragma once

namespace hagfish {

/// Prints them as JSON: length of the animal (cm), and of each state q, qdot, the frames' places
/// (3 x N, column by column), M (row by row) and the forces of motion and gravity, nv.
void print_mirrored_states();

}  // namespace hagfish
