//! Blocks, branches, and changes of the current result.

use super::specs::{FX3U_ONLY, plain};
use crate::target::{Instruction, Opcode, Role};

/// ANB ORB MPS MRD MPP INV MEP MEF.
pub const ROWS: &[Instruction] = &[
    plain(
        0xFFF8,
        "ANB",
        "blocks in series",
        Role::BlockSeries,
        "Joins the two blocks that were begun last in series: the result is on if both are on. It has \
         no device. Each block begins with LD or one of its kin; use ANB where a group of parallel \
         contacts follows other contacts.\n\n\
         ```il\n\
         LD X0\n\
         OR X1\n\
         LD X2\n\
         OR X3\n\
         ANB\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    plain(
        0xFFF9,
        "ORB",
        "blocks in parallel",
        Role::BlockParallel,
        "Joins the two blocks that were begun last in parallel: the result is on if one of them is \
         on. It has no device. Use it where a parallel branch has more than one contact; at most \
         eight blocks may wait to be joined, so it is best written right after the branch that it \
         joins.\n\n\
         ```il\n\
         LD X0\n\
         AND X1\n\
         LD X2\n\
         AND X3\n\
         ORB\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    plain(
        0xFFFA,
        "MPS",
        "branch: store",
        Role::BranchPush,
        "Remembers the current result at a branching point, so that several outputs can hang on the \
         same contacts with further contacts of their own. Each MPS needs an MPP; up to eleven may be \
         open at the same time.\n\n\
         ```il\n\
         LD X0\n\
         MPS\n\
         AND X1\n\
         OUT Y0\n\
         MPP\n\
         AND X2\n\
         OUT Y1\n\
         END\n\
         ```\n",
    ),
    plain(
        0xFFFB,
        "MRD",
        "branch: read",
        Role::BranchRead,
        "Goes back to the result that the last MPS remembered and keeps it for more branches. It \
         stands at every branch but the first, which has MPS, and the last, which has MPP.\n\n\
         ```il\n\
         LD X0\n\
         MPS\n\
         AND X1\n\
         OUT Y0\n\
         MRD\n\
         AND X2\n\
         OUT Y1\n\
         MPP\n\
         AND X3\n\
         OUT Y2\n\
         END\n\
         ```\n",
    ),
    plain(
        0xFFFC,
        "MPP",
        "branch: last",
        Role::BranchPop,
        "Goes back to the result that the last MPS remembered and forgets it: the last branch. An MPS \
         without its MPP is an error that stops the PLC from running.\n\n\
         ```il\n\
         LD X0\n\
         MPS\n\
         AND X1\n\
         OUT Y0\n\
         MPP\n\
         ANI X1\n\
         OUT Y1\n\
         END\n\
         ```\n",
    ),
    plain(
        0xFFFD,
        "INV",
        "invert the result",
        Role::Modify,
        "Turns the current result round: on becomes off and off becomes on. It needs a contact before \
         it and acts on everything since the last LD, in a block on that block alone; INV cannot \
         begin a rung.\n\n\
         ```il\n\
         LD X0\n\
         AND X1\n\
         INV\n\
         OUT Y0\n\
         END\n\
         ```\n",
    ),
    plain(
        0,
        "MEP",
        "pulse at the rising edge of the result",
        Role::Modify,
        "Passes on for one scan when the result of the contacts before it goes from off to on. It \
         makes a pulse of a whole group of contacts without an auxiliary relay. Its memory belongs to \
         this place in the program, so it does not work in subroutines and FOR loops that run several \
         times in a scan.\n\n\
         ```il\n\
         LD X0\n\
         AND X1\n\
         MEP\n\
         SET Y0\n\
         LD X2\n\
         RST Y0\n\
         END\n\
         ```\n",
    )
    .on(FX3U_ONLY)
    .coded(Opcode::Unknown),
    plain(
        0,
        "MEF",
        "pulse at the falling edge of the result",
        Role::Modify,
        "Passes on for one scan when the result of the contacts before it goes from on to off. As \
         with MEP, keep it out of subroutines and FOR loops.\n\n\
         ```il\n\
         LD X0\n\
         AND X1\n\
         MEF\n\
         SET Y0\n\
         LD X2\n\
         RST Y0\n\
         END\n\
         ```\n",
    )
    .on(FX3U_ONLY)
    .coded(Opcode::Unknown),
];
