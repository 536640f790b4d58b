//! Program flow: FNC 00 to 09.

use super::specs::{applied, operand, source};
use crate::target::{Accepts, Access, Instruction, OperandSpec, Role};

const POINTER: OperandSpec = operand("P", "label", Access::Read, Accepts::P);

/// CJ CALL SRET IRET EI DI FEND WDT FOR NEXT.
pub const ROWS: &[Instruction] = &[
    applied(
        0,
        "CJ",
        "conditional jump",
        &[POINTER],
        "Jumps to the label while the result is on, so that the part in between is not executed and \
         takes no time. Outputs in the skipped part stay as they are, on or off, and its timers stand \
         still. A label before the CJ makes a loop that must end before the watchdog does; P63 means \
         END. CJP jumps only in the scan in which the result goes on.\n\n\
         ```il\n\
         LD X0\n\
         CJ P0\n\
         LD X1\n\
         OUT Y0\n\
         P0\n\
         LD X2\n\
         OUT Y1\n\
         END\n\
         ```\n",
    )
    .pulse(),
    applied(
        1,
        "CALL",
        "subroutine call",
        &[POINTER],
        "Executes the subroutine at the label while the result is on, then goes on with the next \
         rung. The subroutine stands behind FEND and ends with SRET. When it is no longer called, its \
         outputs keep their last state; timers inside should be T192 to T199 where the model has \
         them. Calls may be nested five deep. CALLP calls it only in the scan in which the result \
         goes on.\n\n\
         ```il\n\
         LD X0\n\
         CALL P10\n\
         LD X1\n\
         OUT Y0\n\
         FEND\n\
         P10\n\
         LD X2\n\
         OUT Y1\n\
         SRET\n\
         END\n\
         ```\n",
    )
    .pulse(),
    applied(
        2,
        "SRET",
        "return from subroutine",
        &[],
        "Ends a subroutine and goes back to the rung after the CALL. It stands by itself, without \
         contacts before it, once for each subroutine.\n\n\
         ```il\n\
         LD M8000\n\
         CALL P1\n\
         FEND\n\
         P1\n\
         LD X0\n\
         OUT Y0\n\
         SRET\n\
         END\n\
         ```\n",
    )
    .role(Role::Standalone),
    applied(
        3,
        "IRET",
        "return from interrupt",
        &[],
        "Ends an interrupt routine and goes back to where the program was interrupted. It stands by \
         itself, without contacts before it.\n\n\
         ```il\n\
         EI\n\
         LD X1\n\
         OUT Y1\n\
         FEND\n\
         I001\n\
         LD M8000\n\
         INC D0\n\
         IRET\n\
         END\n\
         ```\n",
    )
    .role(Role::Standalone),
    applied(
        4,
        "EI",
        "enable interrupts",
        &[],
        "Allows interrupts from here on, until DI or the end of the main program; a PLC starts with all \
         of them disabled. An interrupt that comes while they are disabled is executed after the next EI. \
         Single sources can be blocked with the relays M8050 and up. The simulator looks at inputs, time \
         and counters when a scan begins, so routines run at the first EI of the scan, those of a timer \
         up to 100 times.\n\n\
         ```il\n\
         EI\n\
         LD X1\n\
         OUT Y1\n\
         FEND\n\
         I001\n\
         LD M8000\n\
         INC D0\n\
         IRET\n\
         END\n\
         ```\n",
    )
    .always(|execution| {
        execution.allow_interrupts(true);
        Ok(())
    })
    .role(Role::Standalone),
    applied(
        5,
        "DI",
        "disable interrupts",
        &[],
        "Blocks interrupts from here on, until EI. Put DI and EI around rungs that must not be \
         interrupted, for instance while two registers that belong together are written.\n\n\
         ```il\n\
         EI\n\
         LD X1\n\
         OUT Y1\n\
         DI\n\
         LD X2\n\
         MOV K4 D1\n\
         EI\n\
         FEND\n\
         I001\n\
         LD M8000\n\
         INC D0\n\
         IRET\n\
         END\n\
         ```\n",
    )
    .always(|execution| {
        execution.allow_interrupts(false);
        Ok(())
    })
    .role(Role::Standalone),
    applied(
        6,
        "FEND",
        "end of main program",
        &[],
        "Ends the main program as END does, with refresh of the outputs, and is followed by \
         subroutines and interrupt routines. It may occur more than once where jumps choose between \
         main programs; END still closes the whole. Labels of CALL and of interrupts stand behind the \
         last FEND.\n\n\
         ```il\n\
         LD X0\n\
         CALL P0\n\
         FEND\n\
         P0\n\
         LD X1\n\
         OUT Y0\n\
         SRET\n\
         END\n\
         ```\n",
    )
    .role(Role::Standalone),
    applied(
        7,
        "WDT",
        "restart the watchdog",
        &[],
        "Restarts the watchdog in the middle of a scan. A scan longer than the time in D8000, 200 ms \
         unless changed, stops the PLC; put WDT into long loops, or write a longer time to D8000 once. \
         The simulator counts instructions instead of time: it stops a scan after 2,500,000 of them, and \
         with WDT after nine times as many.\n\n\
         ```il\n\
         FOR K100\n\
         LD M8000\n\
         INC D0\n\
         WDT\n\
         NEXT\n\
         END\n\
         ```\n",
    )
    .doing(|execution| {
        execution.restart_watchdog();
        Ok(())
    })
    .pulse(),
    applied(
        8,
        "FOR",
        "begin of loop",
        &[source("S", "number of repetitions").within(1, 32767)],
        "Repeats the rungs up to NEXT as often as the operand says, all within one scan; a number \
         below 1 counts as 1. It stands by itself, without contacts before it; to leave a loop out, \
         jump over it with CJ. Loops may be nested five deep, and many repetitions lengthen the scan \
         up to the limit of the watchdog.\n\n\
         ```il\n\
         FOR K4\n\
         LD M8000\n\
         ADD D0 D1 D0\n\
         NEXT\n\
         END\n\
         ```\n",
    )
    .role(Role::Standalone),
    applied(
        9,
        "NEXT",
        "end of loop",
        &[],
        "Ends the loop that FOR began. Each FOR needs its NEXT behind it, before FEND and END.\n\n\
         ```il\n\
         FOR K10\n\
         LD M8000\n\
         INC D0\n\
         NEXT\n\
         END\n\
         ```\n",
    )
    .role(Role::Standalone),
];
