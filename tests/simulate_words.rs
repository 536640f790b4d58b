//! The simulated PLC: instructions on words, groups of bits, times and real numbers.

use super::simulate::{Plc, device};
use rungwise::simulate::ErrorKind;
use rungwise::target::{Device, DeviceKind, Fault, Flow, Instruction, Model, Opcode, Operand, Role};
use rungwise::target::{Semantics, instructions};
use std::collections::BTreeSet;

/// An instruction behind X0, what is set before a scan in which X0 is on, and what is there afterwards.
///
/// `D0=5` is a word, `D0=5L` a pair of registers, `D0=0.5R` a real number in a pair, `K2M0=5` a group of bits, `M0` and
/// `~M0` are relays.
type Case = (&'static str, &'static str, &'static str);

/// The same for what is not executed.
type Refusal = (&'static str, &'static str, Fault, &'static str);

const COMPARE: &[Case] = &[
    ("CMP D0 D1 M0", "D0=5 D1=3 M1 M2", "M0 ~M1 ~M2"),
    ("CMP D0 D1 M0", "D0=-1 D1=1", "~M0 ~M1 M2"),
    ("CMP D0 HFFFF Y0", "D0=-1", "~Y0 Y1 ~Y2"),
    ("DCMP D0 K70000 M0", "D0=70000L", "~M0 M1 ~M2"),
    ("DCMP D0 K70000 M0", "D0=4464", "~M0 ~M1 M2"),
    ("DCMP C200 K-1 M0", "C200=-2", "~M0 ~M1 M2"),
    ("ZCP K20 K80 D0 M0", "D0=19", "M0 ~M1 ~M2"),
    ("ZCP K20 K80 D0 M0", "D0=20", "~M0 M1 ~M2"),
    ("ZCP K20 K80 D0 M0", "D0=80", "~M0 M1 ~M2"),
    ("ZCP K20 K80 D0 M0", "D0=81 M0", "~M0 ~M1 M2"),
    ("ZCP K80 K20 D0 M0", "D0=80", "~M0 M1 ~M2"),
    ("ZCP K80 K20 D0 M0", "D0=50", "M0 ~M1 ~M2"),
    ("DZCP K-70000 K70000 D0 M0", "D0=70001L", "~M0 ~M1 M2"),
];

const MOVES: &[Case] = &[
    ("MOV K100 D0", "", "D0=100"),
    ("MOV H8000 D0", "", "D0=-32768"),
    ("MOV D0 K2M0", "D0=511 M8", "K2M0=255 M8"),
    ("MOV K1M0 D0", "M0 M3 M4", "D0=9"),
    ("MOV K4M0 D0", "M15", "D0=-32768"),
    ("MOV K1M0 K4M20", "M0 M23 M35", "K4M20=1"),
    ("MOV K7 T5", "", "T5=7"),
    ("DMOV K4M0 D0", "M15", "D0=32768L"),
    ("DMOV K8M0 D0", "M0 M31", "D0=-2147483647L"),
    ("DMOV H80000000 D0", "", "D0=0 D1=-32768"),
    ("DMOV K-2 K8M0", "", "~M0 M1 M31"),
    ("DMOV K70000 C200", "", "C200=70000"),
    ("SMOV D0 K4 K2 D1 K3", "D0=1234 D1=5678", "D1=5128"),
    ("SMOVP D0 K2 K2 D1 K4", "D0=1234 D1=5678", "D1=3478"),
    ("SMOV D0 K4 K2 D1 K3", "M8168 D0=4660 D1=22136", "D1=20776"),
    ("SMOV D0 K4 K4 D1 K4", "M8168 D0=-1 D1=0", "D1=-1"),
    ("CML D0 D1", "D0=0", "D1=-1"),
    ("CML D0 K1M0", "D0=5 M4", "K1M0=10 M4"),
    ("CML K1M0 D0", "M0 M2", "D0=-6"),
    ("DCML D0 D2", "D0=65535L", "D2=-65536L"),
    ("BMOV D0 D10 K3", "D0=1 D1=2 D2=3 D13=4", "D10=1 D11=2 D12=3 D13=4"),
    ("BMOV D0 D1 K3", "D0=1 D1=2 D2=3", "D1=1 D2=2 D3=3"),
    ("BMOV D1 D0 K3", "D1=1 D2=2 D3=3", "D0=1 D1=2 D2=3 D3=3"),
    ("BMOV K1M0 K1Y0 K2", "M0 M5", "K1Y0=1 K1Y4=2"),
    ("BMOV D0 K4M0 K2", "D0=1 D1=2", "K4M0=1 K4M16=2"),
    ("BMOV D0 D10 D20", "D20=2 D0=1 D1=2 D2=3", "D10=1 D11=2 D12=0"),
    ("BMOV D0 D10 K2", "M8024 D0=1 D10=4 D11=5", "D0=4 D1=5 D10=4"),
    ("FMOV K7 D0 K3", "D3=1", "D0=7 D1=7 D2=7 D3=1"),
    ("FMOV K5 K2M0 K2", "", "K4M0=1285"),
    ("DFMOV K70000 D0 K2", "D4=9", "D0=70000L D2=70000L D4=9"),
    ("XCH D0 D1", "D0=1 D1=-2", "D0=-2 D1=1"),
    ("DXCH D0 D2", "D0=70000L D2=-1L", "D0=-1L D2=70000L"),
    ("XCH D0 D0", "M8160 D0=258", "D0=513"),
    ("XCH D0 D0", "M8160 D0=-256", "D0=255"),
    ("DXCH D0 D0", "M8160 D0=16909060L", "D0=33620995L"),
    ("SWAP D0", "D0=258", "D0=513"),
    ("SWAP D0", "D0=-256", "D0=255"),
    ("DSWAP D0", "D0=16909060L", "D0=33620995L"),
    ("SWAP K4M0", "M0 M9", "~M0 M1 M8 ~M9"),
    ("BCD D0 D1", "D0=1234", "D1=4660"),
    ("BCD D0 D1", "D0=9999", "D1=-26215"),
    ("BCD D0 K2Y0", "D0=1234", "K2Y0=52"),
    ("DBCD D0 D2", "D0=12345678L", "D2=305419896L"),
    ("DBCD D0 D2", "D0=99999999L", "D2=-1717986919L"),
    ("BIN D0 D1", "D0=4660", "D1=1234"),
    ("BIN D0 D1", "D0=-26215", "D1=9999"),
    ("BIN K2X10 D1", "X10 X15", "D1=21"),
    ("DBIN D0 D2", "D0=-1717986919L", "D2=99999999L"),
];

const INDEXED: &[Case] = &[
    ("MOV D0Z1 D5", "Z1=2 D2=7", "D5=7"),
    ("MOV D10V2 D5", "V2=-3 D7=8", "D5=8"),
    ("MOV K1 D0V0", "V0=4", "D4=1"),
    ("MOV K4M0Z0 D0", "Z0=4 M4 M7", "D0=9"),
    ("MOV K2X0Z0 D0", "Z0=8 X10", "D0=1"),
    ("MOV K9 K1M0Z0", "Z0=4", "K2M0=144"),
    ("MOV K10Z0 D0", "Z0=-3", "D0=7"),
    ("MOV H10V0 D0", "V0=1", "D0=17"),
    ("MOV K32767Z0 D0", "Z0=1", "D0=-32768"),
    ("DMOV K10Z0 D0", "V0=1", "D0=65546L"),
    ("DMOV D0Z0 D10", "Z0=2 D2=70000L", "D10=70000L"),
    ("DMOV K70000 Z0", "", "Z0=4464 V0=1"),
    ("DMOV Z3 D0", "Z3=-1", "D0=65535L"),
    ("DADD Z1 K1 Z1", "Z1=-1 V1=0", "Z1=0 V1=1"),
    ("MOV D8028 D0", "Z0=9", "D0=9"),
    ("MOV K3 D8183", "", "V1=3"),
    ("MOV V7 D0", "D8195=4", "D0=4"),
    ("DMOV D8182 D0", "Z1=1 V1=1", "D0=65537L"),
    ("CMP K1 K2 M0Z0", "Z0=3 M0", "M0 ~M3 ~M4 M5"),
    ("DECO D0 M0Z0 K2", "Z0=8 D0=3", "M11"),
];

const ARITHMETIC: &[Case] = &[
    ("ADD D0 D1 D2", "D0=5 D1=-8 M8020 M8021 M8022", "D2=-3 ~M8020 ~M8021 ~M8022"),
    ("ADD D0 D1 D2", "D0=-5 D1=5", "D2=0 M8020 ~M8021 ~M8022"),
    ("ADD D0 D1 D2", "D0=32767 D1=1", "D2=-32768 ~M8020 ~M8021 M8022"),
    ("ADD D0 D1 D2", "D0=32766 D1=1", "D2=32767 ~M8020 ~M8021 ~M8022"),
    ("ADD D0 D1 D2", "D0=-32768 D1=0", "D2=-32768 ~M8020 ~M8021 ~M8022"),
    ("ADD D0 D1 D2", "D0=-32768 D1=-1", "D2=32767 ~M8020 M8021 ~M8022"),
    ("ADD D0 D1 D2", "D0=-32768 D1=-32768", "D2=0 M8020 M8021 ~M8022"),
    ("ADD K16 K9 K1Y4", "", "K1Y4=9 ~M8020"),
    ("DADD D0 K1 D2", "D0=2147483647L", "D2=-2147483648L M8022"),
    ("DADD D0 K1 D2", "D0=65535L", "D2=0 D3=1 ~M8020"),
    ("SUB D0 D1 D2", "D0=-32768 D1=1", "D2=32767 ~M8020 M8021 ~M8022"),
    ("SUB D0 D1 D2", "D0=32767 D1=-1", "D2=-32768 ~M8020 ~M8021 M8022"),
    ("SUB D0 D0 D2", "D0=7 M8022", "D2=0 M8020 ~M8021 ~M8022"),
    ("DSUB D0 D2 D4", "D0=-2147483648L D2=1L", "D4=2147483647L M8021"),
    ("MUL D0 D1 D2", "D0=300 D1=300 M8022", "D2=90000L M8022"),
    ("MUL D0 D1 D2", "D0=-300 D1=300", "D2=-90000L"),
    ("MUL D0 D0 D2", "D0=-32768", "D2=1073741824L"),
    ("MUL K8 K9 K1Y4", "Y10", "K1Y4=8 Y10"),
    ("MUL D0 D0 K8M0", "D0=300", "K8M0=90000"),
    ("MUL D0 D0 Z0", "D0=300", "Z0=24464 V0=1"),
    ("DMUL D0 D0 D4", "D0=100000L", "D4=1410065408L D6=2L"),
    ("DMUL D0 K-1 D4", "D0=1L", "D4=-1L D6=-1L"),
    ("DMUL D0 D0 K8M0", "D0=100000L M32", "K8M0=1410065408 M32"),
    ("DIV D0 D1 D2", "D0=51 D1=10", "D2=5 D3=1"),
    ("DIV D0 D1 D2", "D0=36 D1=-5", "D2=-7 D3=1"),
    ("DIV D0 D1 D2", "D0=-36 D1=5", "D2=-7 D3=-1"),
    ("DIV K36 K5 Z0", "", "Z0=7 V0=1"),
    ("DIV K36 K5 K1M0", "M4", "K1M0=7 M4"),
    ("DDIV D0 D2 D4", "D0=5500L D2=-540L", "D4=-10L D6=100L"),
    ("DDIV D0 D2 K8M0", "D0=500000L D2=3L", "K8M0=166666"),
    ("INC D0", "D0=32767 M8020", "D0=-32768 M8020 ~M8022"),
    ("INC K1M0", "M0 M1 M2 M3", "K2M0=0"),
    ("DINC D0", "D0=-1L", "D0=0L ~M8020"),
    ("DINC D0", "D0=65535L", "D0=65536L"),
    ("DEC D0", "D0=-32768", "D0=32767 ~M8021"),
    ("DDEC D0", "D0=0L", "D0=-1L"),
    ("WAND D0 H0F D1", "D0=-1", "D1=15"),
    ("WOR D0 H0F D1", "D0=240", "D1=255"),
    ("WXOR D0 D1 D2", "D0=12 D1=10", "D2=6"),
    ("DAND D0 HFFFF0000 D2", "D0=-1L", "D2=-65536L"),
    ("DOR D0 K1 D2", "D0=65536L", "D2=65537L"),
    ("DXOR D0 D0 D2", "D0=65537L D2=1L", "D2=0L"),
    ("NEG D0", "D0=5", "D0=-5"),
    ("NEG D0", "D0=-32768", "D0=-32768"),
    ("DNEG D0", "D0=-32768L", "D0=32768L"),
];

const SHIFT: &[Case] = &[
    ("ROR D0 K4", "D0=4660 M8022", "D0=16675 ~M8022"),
    ("ROR D0 K4", "D0=8", "D0=-32768 M8022"),
    ("ROR D0 K16", "D0=-32767", "D0=-32767 M8022"),
    ("ROR K4M0 K1", "M0", "~M0 M15 M8022"),
    ("DROR D0 K1", "D0=1L", "D0=-2147483648L M8022"),
    ("ROL D0 K4", "D0=-32767", "D0=24 ~M8022"),
    ("ROL D0 K4", "D0=4096", "D0=1 M8022"),
    ("ROL D0 D2", "D0=1 D2=3", "D0=8 ~M8022"),
    ("DROL D0 K32", "D0=-2147483647L", "D0=-2147483647L M8022"),
    ("DROL D0 D2", "D0=1L D2=17L", "D0=131072L"),
    ("RCR D0 K1", "D0=1", "D0=0 M8022"),
    ("RCR D0 K1", "M8022", "D0=-32768 ~M8022"),
    ("RCR D0 K2", "D0=1", "D0=-32768 ~M8022"),
    ("RCL D0 K1", "D0=-32768 M8022", "D0=1 M8022"),
    ("RCL D0 K4", "D0=4096", "D0=0 M8022"),
    ("RCL D0 K5", "D0=4096", "D0=1 ~M8022"),
    ("DRCR D0 K1", "M8022", "D0=-2147483648L ~M8022"),
    ("DRCL D0 K32", "D0=1L", "D0=0L M8022"),
    ("DRCL D0 K32", "D0=2L M8022", "D0=-2147483647L ~M8022"),
    ("SFTR M20 M0 K8 K2", "M20 M2 M7 M8", "M0 ~M1 ~M2 M5 M6 ~M7 M8"),
    ("SFTL M20 M0 K8 K2", "M20 M0 M6 M8", "M0 ~M1 M2 ~M6 ~M7 M8"),
    ("SFTL M0 M0 K4 K1", "M0", "K2M0=3"),
    ("SFTL X1 Y0 K4 D0", "X2 Y0 D0=3", "K1Y0=10"),
    ("WSFR D0 D10 K4 K2", "D0=8 D1=9 D10=1 D11=2 D12=3 D13=4", "D10=3 D11=4 D12=8 D13=9"),
    ("WSFL D0 D10 K4 K2", "D0=8 D1=9 D10=1 D11=2 D12=3 D13=4", "D10=8 D11=9 D12=1 D13=2"),
    ("WSFR K1M0 K1Y0 K2 K1", "M0 M1 M2 Y0 Y5", "K2Y0=114"),
    ("SFWR D0 D10 K3", "D0=5 M8022", "D10=1 D11=5 ~M8022"),
    ("SFWR D0 D10 K3", "D0=6 D10=1 D11=5", "D10=2 D11=5 D12=6"),
    ("SFWR D0 D10 K3", "D0=7 D10=2 D11=5 D12=6", "D10=2 D11=5 D12=6 M8022"),
    ("SFRD D10 D0 K4", "D10=3 D11=7 D12=8 D13=9 M8020", "D0=7 D10=2 D11=8 D12=9 D13=9 ~M8020"),
    ("SFRD D10 D0 K2", "D10=1 D11=7", "D0=7 D10=0 D11=7"),
    ("SFRD D10 D0 K4", "D0=4 D11=7", "D0=4 D10=0 M8020"),
];

const DATA: &[Case] = &[
    ("ZRST M1 M3", "M0 M1 M2 M3 M4", "M0 ~M1 ~M2 ~M3 M4"),
    ("ZRST D0 D2", "D0=1 D1=2 D2=3 D3=4", "D0=0 D1=0 D2=0 D3=4"),
    ("ZRST D5 D3", "D3=1 D4=1 D5=1", "D5=0 D4=1 D3=1"),
    ("ZRST T0 T1", "T0=5 T1=6 T2=7", "T0=0 T1=0 T2=7"),
    ("ZRST C200 C201", "C199=1 C200=70000 C201=1", "C199=1 C200=0 C201=0"),
    ("ZRST S0 S9", "S0 S9 S10", "~S0 ~S9 S10"),
    ("DECO D0 M10 K3", "D0=5 M10 M18", "~M10 M15 M18"),
    ("DECO D0 M0 K8", "D0=511", "M255 ~M0"),
    ("DECO M0 D0 K3", "M0 M1 M3 D0=-1", "D0=8"),
    ("DECO D1 D0 K4", "D1=31", "D0=-32768"),
    ("DECO K2 Y0 K2", "Y0", "K1Y0=4"),
    ("ENCO M0 D0 K3", "M2 M5 M8", "D0=5"),
    ("ENCO D1 D0 K4", "D1=-32768", "D0=15"),
    ("ENCO D1 D0 K2", "D1=20", "D0=2"),
    ("ENCO M0 D0 K1", "M0 D0=7", "D0=0"),
    ("SUM D0 D1", "D0=-1 M8020", "D1=16 ~M8020"),
    ("SUM D0 D1", "D1=3", "D1=0 M8020"),
    ("SUM K4X10 D1", "X10 X17 X27", "D1=3"),
    ("DSUM D0 D2", "D0=-1L D3=9", "D2=32L"),
    ("BON D0 M0 K15", "D0=-1", "M0"),
    ("BON D0 M0 D1", "D0=-5 D1=2 M0", "~M0"),
    ("DBON D0 M0 K31", "D0=-1L", "M0"),
    ("DBON D0 M0 K15", "D0=65536L M0", "~M0"),
    ("MEAN D0 D10 K3", "D0=1 D1=2 D2=6", "D10=3"),
    ("MEAN D0 D10 K2", "D0=-3 D1=0", "D10=-1"),
    ("MEAN D0 D10 K2", "D0=32767 D1=32767", "D10=32767"),
    ("MEAN K1M0 D0 K2", "M0 M1 M4 M6", "D0=4"),
    ("DMEAN D0 D10 K2", "D0=70000L D2=70001L", "D10=70000L"),
    ("DMEAN C200 D10 K2", "C200=70000 C201=2", "D10=35001L"),
    ("SQR D0 D1", "D0=10 M8020", "D1=3 M8021 ~M8020"),
    ("SQR D0 D1", "D0=9 M8021", "D1=3 ~M8021"),
    ("SQR D0 D1", "D1=5", "D1=0 M8020 ~M8021"),
    ("DSQR D0 D2", "D0=2147483647L", "D2=46340L M8021"),
    ("FLT D0 D2", "D0=5", "D2=5R"),
    ("FLT D0 D2", "D0=-1", "D2=-1R"),
    ("DFLT D0 D2", "D0=16777217L", "D2=16777216R"),
    ("ANRP", "S899 S950 S901", "S899 S950 ~S901"),
    ("ANR", "", "~S900"),
];

const TIMES: &[Case] = &[
    ("TCMP K6 K30 K0 D0 M0", "D0=6 D1=29 D2=59", "M0 ~M1 ~M2"),
    ("TCMP K6 K30 K0 D0 M0", "D0=6 D1=30 D2=0 M0", "~M0 M1 ~M2"),
    ("TCMP K6 K30 K0 D0 M0", "D0=7", "~M0 ~M1 M2"),
    ("TZCP D0 D3 D6 M0", "D0=6 D3=14 D6=5 D7=59 D8=59", "M0 ~M1 ~M2"),
    ("TZCP D0 D3 D6 M0", "D0=6 D3=14 D6=14", "~M0 M1 ~M2"),
    ("TZCP D0 D3 D6 M0", "D0=6 D3=14 D6=14 D8=1", "~M0 ~M1 M2"),
    ("TZCP D0 D3 D6 M0", "D0=14 D3=6 D6=14", "~M0 M1 ~M2"),
    ("TADD D0 D3 D6", "D0=1 D1=50 D2=30 D3=2 D4=20 D5=40 M8020 M8022", "D6=4 D7=11 D8=10 ~M8020 ~M8022"),
    ("TADD D0 D3 D6", "D0=23 D1=59 D2=59 D5=1 D6=9", "D6=0 D7=0 D8=0 M8020 M8022"),
    ("TSUB D0 D3 D6", "D0=10 D3=3 D4=30 D5=1 M8021", "D6=6 D7=29 D8=59 ~M8020 ~M8021"),
    ("TSUB D0 D3 D6", "D0=1 D3=2", "D6=23 D7=0 D8=0 ~M8020 M8021"),
    ("TSUB D0 D3 D6", "D0=1 D3=1 D6=9", "D6=0 D7=0 D8=0 M8020 ~M8021"),
    ("TRD D0", "D0=7", "D0=0 D1=1 D2=1 D3=0 D4=0 D5=0 D6=6"),
    (
        "TWR D0",
        "D0=24 D1=2 D2=29 D3=23 D4=58 D5=57 D6=4",
        "D8018=24 D8017=2 D8016=29 D8015=23 D8014=58 D8013=57 D8019=4",
    ),
    ("HOUR K1 D0 Y0", "D0=1 D1=1", "D0=1 D1=1 Y0"),
    ("DHOUR K1 D0 Y0", "D0=70000L D2=9 Y0", "D0=70000L D2=9 Y0"),
    ("GRY D0 D1", "D0=5", "D1=7"),
    ("GRY D0 K2Y0", "D0=32767", "K2Y0=0"),
    ("DGRY D0 D2", "D0=2147483647L", "D2=1073741824L"),
    ("GBIN D0 D1", "D0=7", "D1=5"),
    ("GBIN K3X10 D1", "X23", "D1=4095"),
    ("DGBIN D0 D2", "D0=1073741824L", "D2=2147483647L"),
    ("RD3A K0 K1 D0", "D0=123", "D0=0"),
    ("WR3A K0 K1 D0", "D0=123", "D0=123"),
    ("WDT", "", ""),
];

const REALS: &[Case] = &[
    ("DECMP D0 D2 M0", "D0=1.5R D2=1.25R", "M0 ~M1 ~M2"),
    ("DECMP D0 K100 M0", "D0=100R", "~M0 M1 ~M2"),
    ("DECMP D0 D2 M0", "D0=-0R D2=0R", "~M0 M1 ~M2"),
    ("DECMP D0 E1.5 M0", "D0=1R", "~M0 ~M1 M2"),
    ("DEZCP K20 K80 D0 M0", "D0=19.9R", "M0 ~M1 ~M2"),
    ("DEZCP K20 K80 D0 M0", "D0=80R", "~M0 M1 ~M2"),
    ("DEZCP K80 K20 D0 M0", "D0=80R", "~M0 M1 ~M2"),
    ("DEZCP K80 K20 D0 M0", "D0=80.5R", "~M0 ~M1 M2"),
    ("DEBCD D0 D2", "D0=3.142R", "D2=3142 D3=-3"),
    ("DEBCD D0 D2", "D0=9999.6R", "D2=1000 D3=1"),
    ("DEBCD D0 D2", "D0=-1e10R", "D2=-1000 D3=7"),
    ("DEBCD D0 D2", "D2=5 D3=5", "D2=0 D3=0"),
    ("DEBIN D0 D2", "D0=3142 D1=-3", "D2=3.142R"),
    ("DEBIN D0 D2", "D0=-1000 D1=7", "D2=-1e10R"),
    ("DEBIN D0 D2", "D1=5 D2=1R", "D2=0R"),
    ("DEADD D0 K5 D2", "D0=1.5R M8020", "D2=6.5R ~M8020 ~M8021 ~M8022"),
    ("DEADD D0 D0 D2", "D0=3e38R", "D2=3.4028235e38R M8022"),
    ("DESUB D0 D0 D2", "D0=1.5R", "D2=0R M8020 ~M8021 ~M8022"),
    ("DESUB D0 E0.5 D2", "D0=0.25R", "D2=-0.25R"),
    ("DESUB D0 D2 D4", "D0=-3e38R D2=3e38R", "D4=-3.4028235e38R M8022"),
    ("DEMUL D0 D2 D4", "D0=1.5R D2=-2R", "D4=-3R"),
    ("DEMUL D0 D2 D4", "D0=1e-30R D2=-1e-30R", "D4=-1.1754944e-38R M8021 ~M8020"),
    ("DEMUL D0 K0 D4", "D0=-1R", "D4=0R D5=0 M8020"),
    ("DEDIV D0 K4 D2", "D0=1R", "D2=0.25R"),
    ("DEDIV D0 K3 D2", "D0=1R", "D2=0.33333334R"),
    ("DESQR D0 D2", "D0=2R", "D2=1.4142135R ~M8020"),
    ("DESQR D0 D2", "D2=1R", "D2=0R M8020"),
    ("INT D0 D2", "D0=2.9R D3=7 M8022", "D2=2 D3=7 M8021 ~M8020 ~M8022"),
    ("INT D0 D2", "D0=-2.9R", "D2=-2 M8021"),
    ("INT D0 D2", "D0=3R M8021", "D2=3 ~M8021"),
    ("INT D0 D2", "D0=-0.5R D2=9", "D2=0 M8020 M8021"),
    ("INT D0 D2", "D0=40000R D2=9", "D2=9 M8022 ~M8020 ~M8021"),
    ("INT D0 D2", "D0=-32768.5R", "D2=-32768 M8021 ~M8022"),
    ("DINT D0 D2", "D0=40000R", "D2=40000L ~M8022"),
    ("DINT D0 D2", "D0=1e10R D2=9L", "D2=9L M8022"),
    ("DSIN D0 D2", "D0=0R D2=1R", "D2=0R"),
    ("DSIN D0 D2", "D0=1.5707964R", "D2=1R"),
    ("DCOS D0 D2", "D0=0R", "D2=1R"),
    ("DCOS D0 D2", "D0=3.1415927R", "D2=-1R"),
    ("DTAN D0 D2", "D0=0R D2=1R", "D2=0R"),
    ("DTAN D0 D2", "D0=0.7853982R", "D2=1R"),
];

const REFUSALS: &[Refusal] = &[
    ("DIV D0 D1 D2", "D0=5 D2=9", Fault::DivisionByZero, "D2=9 D3=0"),
    ("DDIV D0 D2 D4", "D0=5L D6=9L", Fault::DivisionByZero, "D6=9L"),
    ("DIV D0 K-1 D2", "D0=-32768 D2=9", Fault::Overflow, "D2=9"),
    ("DDIV D0 K-1 D2", "D0=-2147483648L D2=9", Fault::Overflow, "D2=9"),
    ("DMUL D0 D2 Z0", "D0=2L D2=3L", Fault::NoDevice(2), "Z0=0"),
    ("MOV D0Z0 D1", "Z0=-1 D1=5", Fault::NoDevice(0), "D1=5"),
    ("MOV K1 D1Z0", "Z0=-2", Fault::NoDevice(1), "D0=0"),
    ("MOV D7000Z0 D1", "Z0=1000 D1=5", Fault::NoDevice(0), "D1=5"),
    ("MOV D8010Z0 D1", "Z0=-11 D1=5", Fault::NoDevice(0), "D1=5"),
    ("MOV K4M0Z0 D1", "Z0=7670 D1=5", Fault::NoDevice(0), "D1=5"),
    ("MOV K-1 K4M0Z0", "Z0=7670", Fault::NoDevice(1), "~M7670"),
    ("MOV C199Z0 D1", "Z0=1 C200=5", Fault::NoDevice(0), "D1=0"),
    ("DMOV D0Z0 D10", "Z0=2 V0=1 D2=5", Fault::NoDevice(0), "D10=0"),
    ("DMOV D0V0 D10", "V0=2 D2=5", Fault::NoDevice(0), "D10=0"),
    ("DMOV V0 D10", "V0=2", Fault::NoDevice(0), "D10=0"),
    ("DMOV K1 D7999", "", Fault::NoDevice(1), "D7999=0"),
    ("DMOV K1 C199", "", Fault::NoDevice(1), "C199=0"),
    ("CMP K1 K2 M7678", "M7678", Fault::NoDevice(2), "M7678"),
    ("BMOV D7990 D0 K20", "D7990=5", Fault::NoDevice(0), "D0=0"),
    ("BMOV D0 D7990 K20", "D0=5", Fault::NoDevice(1), "D7990=0"),
    ("BMOV D0 D10 D20", "D0=5 D20=0", Fault::Value(2), "D10=0"),
    ("BMOV K1M0 K2Y0 K2", "M0", Fault::Value(1), "~Y0"),
    ("FMOV K1 D7990 K20", "", Fault::NoDevice(1), "D7990=0"),
    ("DFMOV K1 D7990 K6", "", Fault::NoDevice(1), "D7990=0"),
    ("XCH D0 D1", "M8160 D0=5", Fault::Value(1), "D0=5"),
    ("SMOV D0 K2 K3 D1 K4", "D0=1234", Fault::Value(2), "D1=0"),
    ("SMOV D0 K4 K1 D1 K4", "D0=-1", Fault::Value(0), "D1=0"),
    ("SMOV D0 K4 K1 D1 K4", "D1=10000", Fault::Value(3), "D1=10000"),
    ("BCD D0 D1", "D0=10000", Fault::Value(0), "D1=0"),
    ("BCD D0 D1", "D0=-1", Fault::Value(0), "D1=0"),
    ("DBCD D0 D2", "D0=100000000L", Fault::Value(0), "D2=0L"),
    ("BIN D0 D1", "D0=26 D1=3", Fault::Value(0), "D1=3"),
    ("ROR D0 D1", "D0=5 D1=17", Fault::Value(1), "D0=5"),
    ("ROL D0 D1", "D0=5 D1=0", Fault::Value(1), "D0=5"),
    ("RCR K3M0 K1", "M0", Fault::Value(0), "M0"),
    ("SFTL X1 M0 K4 D0", "D0=5 M0", Fault::Value(3), "M0 ~M1"),
    ("SFTR X1 M7678 K4 K1", "X1", Fault::NoDevice(1), "~M7678"),
    ("WSFR K1M0 K2Y0 K2 K1", "M0", Fault::Value(1), "~Y4"),
    ("SFWR D0 D10 K3", "D0=5 D10=-1", Fault::Value(1), "D10=-1"),
    ("SFRD D10 D0 K3", "D10=3", Fault::Value(0), "D10=3"),
    ("ZRST D0 M3", "D0=5", Fault::Value(1), "D0=5"),
    ("ZRST C199 C200", "C199=5", Fault::Value(1), "C199=5"),
    ("ZRST M0 M8010", "M0", Fault::NoDevice(0), "M0"),
    ("DECO D0 D1 K5", "D0=1", Fault::Value(2), "D1=0"),
    ("DECO D0 M7600 K8", "M7600 D0=1", Fault::NoDevice(1), "M7600 ~M7601"),
    ("ENCO M0 D0 K3", "D0=5", Fault::Value(0), "D0=5"),
    ("BON D0 M0 D1", "D0=-1 D1=16", Fault::Value(2), "~M0"),
    ("MEAN D0 D10 D5", "D0=1 D5=65", Fault::Value(2), "D10=0"),
    ("SQR D0 D1", "D0=-1 D1=5", Fault::Value(0), "D1=5"),
    ("TCMP K6 D9 K0 D0 M0", "D9=60 M1", Fault::Value(0), "M1"),
    ("TZCP D0 D3 D6 M0", "D7=60", Fault::Value(2), "~M0"),
    ("TADD D0 D3 D6", "D3=24 D6=5", Fault::Value(1), "D6=5"),
    ("TSUB D0 D3 D6", "D2=-1 D6=5", Fault::Value(0), "D6=5"),
    ("TWR D0", "D0=23 D1=2 D2=29", Fault::Value(0), "D8018=0 D8016=1 ~M8019"),
    ("GRY D0 D1", "D0=-1", Fault::Value(0), "D1=0"),
    ("DGBIN D0 D2", "D0=-1L", Fault::Value(0), "D2=0L"),
    ("RD3A D1 K1 D0", "D1=8 D0=5", Fault::Value(0), "D0=5"),
    ("RD3A K0 K100 D0", "D0=5", Fault::Value(1), "D0=5"),
    ("WR3A D1 K1 D0", "D1=-1 D0=5", Fault::Value(0), "D0=5"),
    ("DEADD D0 D2 D4", "D2=-1L D4=5", Fault::Value(1), "D4=5"),
    ("DECMP D0 D2 M0", "D0=2139095040L M1", Fault::Value(0), "M1"),
    ("DEDIV D0 D2 D4", "D0=1R D4=5", Fault::DivisionByZero, "D4=5"),
    ("DESQR D0 D2", "D0=-1R D2=5", Fault::Value(0), "D2=5"),
    ("DEBIN D0 D2", "D0=1000 D1=36 D2=5", Fault::Overflow, "D2=5"),
    ("INT D0 D2", "D0=-1L D2=5", Fault::Value(0), "D2=5"),
    ("DTAN D0 D2", "D0=-1L D2=5", Fault::Value(0), "D2=5"),
];

/// All tables whose instructions are executed.
const TABLES: &[&[Case]] = &[COMPARE, MOVES, INDEXED, ARITHMETIC, SHIFT, DATA, TIMES, REALS];

/// Splits `K2M0=5` and the like.
fn named(token: &str) -> (&str, &str) {
    token.split_once('=').unwrap_or((token, ""))
}

/// The register with the upper half.
fn upper(register: Device) -> Device {
    match register.kind {
        DeviceKind::Z => Device::new(DeviceKind::V, register.number),
        _ => Device::new(register.kind, register.number + 1),
    }
}

fn set(plc: &mut Plc, settings: &str) {
    for token in settings.split_whitespace() {
        let (name, value) = named(token);
        let bits = match (value.strip_suffix('L'), value.strip_suffix('R')) {
            (Some(number), _) => number.parse::<i32>().expect("a number"),
            (_, Some(real)) => real.parse::<f32>().expect("a real number").to_bits() as i32,
            _ => {
                plc.set(token);
                continue;
            }
        };
        plc.machine.set_word(device(name), i64::from(bits as i16));
        plc.machine.set_word(upper(device(name)), i64::from(bits >> 16));
    }
}

fn pair(plc: &Plc, name: &str) -> i32 {
    let (lower, upper) = (plc.word(name), plc.machine.word(upper(device(name)), 0));
    (upper as i32) << 16 | i32::from(lower as u16)
}

fn group(plc: &Plc, name: &str) -> i64 {
    let Operand::Nibbles { digits, first, .. } = Operand::read(name, Model::Fx3u) else { panic!("{name}") };
    let is_on = |place| plc.machine.bit(Device::new(first.kind, first.number + place)) != 0;
    (0..u32::from(digits) * 4).map(|place| i64::from(is_on(place)) << place).sum()
}

/// What is there, in the words of what is expected.
fn found(plc: &Plc, expected: &str) -> String {
    let look = |token: &str| {
        let (name, value) = named(token);
        match name.strip_prefix('~') {
            _ if value.ends_with('L') => format!("{name}={}L", pair(plc, name)),
            _ if value.ends_with('R') => format!("{name}={:?}R", f32::from_bits(pair(plc, name) as u32)),
            _ if name.starts_with('K') => format!("{name}={}", group(plc, name)),
            _ if !value.is_empty() => format!("{name}={}", plc.word(name)),
            Some(relay) => format!("{}{relay}", if plc.on(relay) { "" } else { "~" }),
            None => format!("{}{name}", if plc.on(name) { "" } else { "~" }),
        }
    };
    expected.split_whitespace().map(look).collect::<Vec<_>>().join(" ")
}

/// The same with real numbers as they are shown.
fn normal(expected: &str) -> String {
    let show = |token: &str| match token.split_once('=') {
        Some((name, value)) if value.ends_with('R') => {
            let real: f32 = value.trim_end_matches('R').parse().expect("a real number");
            format!("{name}={real:?}R")
        }
        _ => token.to_string(),
    };
    expected.split_whitespace().map(show).collect::<Vec<_>>().join(" ")
}

fn driven(instruction: &str, before: &str) -> (String, Plc) {
    let text = format!("LD X0\n{instruction}\nEND\n");
    let mut plc = Plc::list(&text);
    set(&mut plc, before);
    plc.set("X0");
    (text, plc)
}

fn check(cases: &[Case]) {
    let mut wrong = Vec::new();
    for (instruction, before, after) in cases {
        let (_, mut plc) = driven(instruction, before);
        let errors = plc.scan().errors;
        let found = found(&plc, after);
        if !errors.is_empty() || found != normal(after) {
            wrong.push(format!("{instruction} with {before}: {found} instead of {after}, {errors:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The row that stands in a case.
fn row_of(instruction: &str) -> &'static str {
    let word = instruction.split(' ').next().expect("a mnemonic");
    rungwise::target::Form::named(word).unwrap_or_else(|| panic!("{word}")).instruction.mnemonic
}

/// The rows whose code this file tests.
fn rows() -> impl Iterator<Item = &'static Instruction> {
    instructions::all().filter(|row| {
        matches!(row.opcode, Opcode::Function(7 | 10..=49 | 110..=132 | 147 | 160..=171 | 176..=177))
    })
}

#[test]
fn comparisons_switch_one_of_three_relays() {
    check(COMPARE);
}

#[test]
fn values_are_moved_and_converted() {
    check(MOVES);
}

#[test]
fn index_registers_move_devices_and_constants() {
    check(INDEXED);
}

#[test]
fn arithmetic_is_done_in_the_width_of_the_instruction() {
    check(ARITHMETIC);
}

#[test]
fn rows_and_words_are_shifted_and_rotated() {
    check(SHIFT);
}

#[test]
fn data_are_worked_on() {
    check(DATA);
}

#[test]
fn times_and_codes_are_computed() {
    check(TIMES);
}

#[test]
fn real_numbers_are_computed_in_single_precision() {
    check(REALS);
}

#[test]
fn what_cannot_be_executed_is_told_at_its_place_and_changes_nothing() {
    let mut wrong = Vec::new();
    for (instruction, before, fault, after) in REFUSALS {
        let (text, mut plc) = driven(instruction, before);
        let errors = plc.scan().errors;
        let code = if matches!(fault, Fault::NoDevice(_)) { 6705 } else { 6706 };
        let after = format!("{after} M8067 D8067={code} M8004");
        let found = found(&plc, &after);
        let is_told = errors.len() == 1
            && errors[0].kind == ErrorKind::Fault(*fault)
            && errors[0]
                .place
                .is_some_and(|place| text[place.span.start as usize..].starts_with(instruction));
        if !is_told || found != normal(&after) {
            wrong.push(format!("{instruction} with {before}: {found}, {errors:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn nothing_happens_without_power() {
    let mut wrong = Vec::new();
    for (instruction, before, _) in TABLES.iter().copied().flatten() {
        let (_, mut plc) = driven(instruction, before);
        plc.set("X0=0").scans(1);
        let (_, mut other) = driven("WDT", before);
        other.set("X0=0").scans(1);
        // Behind the words of devices lies what instructions note.
        let words = plc.machine.code().layout.slots();
        let changed = plc.machine.memory().words()[..words] != other.machine.memory().words()[..words];
        let relays = ["M", "Y", "S"].iter().any(|kind| {
            (0..100).any(|number| {
                let Operand::Device(device) = Operand::read(&format!("{kind}{number}"), Model::Fx3u) else {
                    return false;
                };
                plc.machine.bit(device) != other.machine.bit(device)
            })
        });
        if changed || relays {
            wrong.push(*instruction);
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn every_row_has_its_code_and_is_tested() {
    let basic: Vec<_> = rows()
        .filter(|row| row.role == Role::Output && row.flow() == Flow::Straight)
        .filter(|row| matches!(row.semantics, Semantics::Basic))
        .map(|row| row.mnemonic)
        .collect();
    assert!(basic.is_empty(), "{basic:?}");
    let tested: BTreeSet<&str> =
        TABLES.iter().copied().flatten().map(|(instruction, ..)| row_of(instruction)).collect();
    let lacking: Vec<_> =
        rows().map(|row| row.mnemonic).filter(|name| !tested.contains(name) && *name != "ANS").collect();
    assert!(lacking.is_empty(), "{lacking:?}");
    assert!(rows().count() > 60, "{}", rows().count());
}

#[test]
fn pulse_forms_are_executed_when_power_arrives() {
    let mut plc = Plc::list("LD X0\nINCP D0\nINC D1\nMOVP K1X4 D2\nMOVP K1X4 K1M0\nEND\n");
    plc.set("X0 X5")
        .scans(1)
        .check("D0=1 D1=1 D2=2 M1")
        .set("X5=0 X4")
        .scans(2)
        .check("D0=1 D1=3 D2=2 M1 ~M0");
    plc.set("X0=0").scans(2).check("D0=1 D1=3").set("X0").scans(1).check("D0=2 D1=4 D2=1 M0 ~M1");
}

#[test]
fn loops_are_made_once_at_least() {
    let mut plc = Plc::list("FOR D5\nLD M8000\nINC D0\nNEXT\nEND\n");
    plc.scans(1).check("D0=1").set("D5=-3").scans(1).check("D0=2").set("D5=4").scans(1).check("D0=6");
}

/// A generator that gives the same numbers on every machine.
fn numbers(count: usize) -> impl Iterator<Item = i64> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    std::iter::repeat_with(move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        i64::from((state >> 32) as i32) >> (state >> 20 & 31)
    })
    .take(count)
}

/// Limits, their neighbours, and some numbers between, with `bits` bits.
fn operands(bits: u32) -> Vec<i64> {
    let half = 1_i64 << (bits - 1);
    let mut operands = vec![-half, -half + 1, -2, -1, 0, 1, 2, 9, half / 2, half - 2, half - 1];
    operands.extend(numbers(12).map(|number| (number + half).rem_euclid(2 * half) - half));
    operands
}

#[test]
fn arithmetic_agrees_with_that_of_wider_numbers() {
    for bits in [16, 32] {
        let d = if bits == 32 { "D" } else { "" };
        let flags = |to: i32| {
            let one = |flag, to| format!("LD {flag}\nOUT M{to}\n");
            format!("{}{}{}LD M8000\n", one("M8020", to), one("M8021", to + 1), one("M8022", to + 2))
        };
        let text = format!(
            "LD M8000\n{d}ADD D0 D2 D10\n{}{d}SUB D0 D2 D12\n{}{d}MUL D0 D2 D14\n{d}AND D0 D2 D30\n\
             {d}OR D0 D2 D32\n{d}XOR D0 D2 D34\n{d}DIV D0 D2 D20\nEND\n",
            flags(0),
            flags(3),
        );
        let text = if bits == 16 {
            text.replace("\nAND", "\nWAND").replace("\nOR D0", "\nWOR D0").replace("\nXOR", "\nWXOR")
        } else {
            text
        };
        let mut plc = Plc::list(&text);
        let wrap = |number: i64| if bits == 32 { i64::from(number as i32) } else { i64::from(number as i16) };
        for a in operands(bits) {
            for b in operands(bits) {
                let suffix = if bits == 32 { "L" } else { "" };
                set(&mut plc, &format!("D0={a}{suffix} D2={b}{suffix}"));
                let errors = plc.scan().errors;
                let half = 1 << (bits - 1);
                let word = |name| if bits == 32 { i64::from(pair(&plc, name)) } else { plc.word(name) };
                let case = format!("{a} and {b} with {bits} bits");
                for (to, first, number) in [("D10", 0, a + b), ("D12", 3, a - b)] {
                    assert_eq!(word(to), wrap(number), "{case}");
                    let expected = [wrap(number) == 0, number < -half, number >= half];
                    let found = [0, 1, 2].map(|place| plc.on(&format!("M{}", first + place)));
                    assert_eq!(found, expected, "{case}");
                }
                let product = match bits {
                    32 => i64::from(pair(&plc, "D16")) << 32 | i64::from(pair(&plc, "D14") as u32),
                    _ => i64::from(pair(&plc, "D14")),
                };
                assert_eq!(product, a * b, "{case}");
                assert_eq!([word("D30"), word("D32"), word("D34")], [a & b, a | b, a ^ b], "{case}");
                let is_divided = b != 0 && a / b < half;
                assert_eq!(errors.is_empty(), is_divided, "{case}: {errors:?}");
                if is_divided {
                    let remainder = if bits == 32 { "D22" } else { "D21" };
                    assert_eq!((word("D20"), word(remainder)), (a / b, a % b), "{case}");
                }
            }
        }
    }
}

#[test]
fn codes_and_rotations_turn_back() {
    let text = "LD M8000\nDGRY D0 D2\nDGBIN D2 D4\nDMOV D0 D6\nDROR D6 D10\nDROL D6 D10\nDMOV D0 D12\n\
                DRCR D12 D10\nDRCL D12 D10\nDMOV D0 D14\nDNEG D14\nDNEG D14\nDCML D0 D16\nEND\n";
    let mut plc = Plc::list(text);
    for number in numbers(100).map(|number| number & 0x7FFF_FFFF) {
        let by = number % 32 + 1;
        set(&mut plc, &format!("D0={number}L D10={by}L"));
        plc.scans(1);
        let expected = format!("D4={number}L D6={number}L D12={number}L D14={number}L D16={}L", !number);
        assert_eq!(found(&plc, &expected), expected);
        let gray = pair(&plc, "D2");
        assert_eq!((gray ^ (number ^ number >> 1) as i32, gray >= 0), (0, true), "{number}");
    }
}

#[test]
fn real_arithmetic_agrees_with_that_of_the_machine() {
    let text = "LD M8000\nDEADD D0 D2 D10\nDESUB D0 D2 D12\nDEMUL D0 D2 D14\nDEDIV D0 D2 D16\nDSIN D0 D20\n\
                DCOS D0 D22\nDEMUL D20 D20 D24\nDEMUL D22 D22 D26\nDEADD D24 D26 D28\nDTAN D0 D30\n\
                DEDIV D20 D22 D32\nEND\n";
    let mut plc = Plc::list(text);
    let reals: Vec<f32> = numbers(24).map(|number| number as f32 / 4096.0 + 0.1).collect();
    for a in &reals {
        for b in &reals {
            set(&mut plc, &format!("D0={a:?}R D2={b:?}R"));
            plc.scans(1);
            let expected = format!("D10={:?}R D12={:?}R D14={:?}R D16={:?}R", a + b, a - b, a * b, a / b);
            assert_eq!(found(&plc, &expected), expected.replace("=-0.0R", "=0.0R"), "{a} and {b}");
            let real = |name| f32::from_bits(pair(&plc, name) as u32);
            assert!((real("D28") - 1.0).abs() < 1e-6, "{a}");
            assert!((real("D30") / real("D32") - 1.0).abs() < 1e-5, "{a}: {} {}", real("D30"), real("D32"));
        }
    }
}

#[test]
fn annunciators_wait_and_are_watched() {
    let text = "LD M8000\nOUT M8049\nLD X0\nANS T0 K3 S910\nLD X1\nANS T1 D0 S905\nLD X2\nANRP\n\
                LD M8048\nOUT Y0\nEND\n";
    let mut plc = Plc::list(text);
    plc.scan_ms = 100;
    plc.set("X0").scans(3).check("~S910 T0=2 ~T0 ~Y0").scans(1).check("S910 T0=3 T0 ~Y0");
    plc.scans(1).check("Y0 D8049=910 T0=3").set("X0=0 X1 D0=1").scans(2).check("S910 S905 ~T0 T0=0 T1");
    plc.scans(1).check("D8049=905").set("X1=0 X2").scans(2).check("~S905 S910 D8049=910 Y0 T1=0");
    plc.set("X2=0").scans(1).set("X2").scans(2).check("~S910 ~Y0 D8049=0");
    plc.set("X0").scans(3).set("X0=0").scans(1).check("T0=0 ~S910").set("X0").scans(3).check("T0=2 ~S910");
}

#[test]
fn an_hour_meter_counts_while_it_is_driven() {
    let mut plc = Plc::list("LD X0\nHOUR K1 D0 Y0\nLD X1\nDHOUR K0 D10 Y1\nEND\n");
    plc.scan_ms = 400;
    plc.set("D0=0 D1=3598 X0").scans(3).check("D0=0 D1=3598").scans(1).check("D1=3599");
    plc.set("X0=0").scans(9).check("D1=3599").set("X0").scans(1).check("D1=3599");
    plc.scans(2).check("D0=1 D1=0 ~Y0").scans(3).check("D0=1 D1=1 Y0");
    plc.set("D0=32767 D1=3599").scans(9).check("D0=32767 D1=3599").set("D0=0 D1=0").scans(1).check("~Y0");
    plc.set("X1 D12=3599").scans(4).check("D10=1 D11=0 D12=0 Y1");
}

#[test]
fn analog_modules_have_their_values_in_buffer_memory() {
    let mut plc = Plc::list("LD X0\nRD3A K0 K21 D0\nWR3A K1 D2 D1\nEND\n");
    plc.machine.outside_mut()[0].set_buffer(0, 21, 1234);
    plc.set("X0 D1=77 D2=1").scans(1).check("D0=1234");
    assert_eq!(plc.machine.outside()[0].buffer(1, 101), Some(77));
    plc.machine.outside_mut()[0].set_module(0, false);
    let errors = plc.scan().errors;
    assert_eq!(
        errors.iter().map(|error| error.kind).collect::<Vec<_>>(),
        [ErrorKind::Fault(Fault::NoModule)]
    );
    plc.check("D0=1234 M8067 D8067=6708");
}

#[test]
fn the_clock_goes_on_with_the_scans() {
    let mut plc = Plc::list("LD X0\nTRD D0\nEND\n");
    plc.scan_ms = 700;
    plc.scans(1).check("D8018=0 D8017=1 D8016=1 D8015=0 D8014=0 D8013=0 D8019=6 M8018 ~M8019");
    plc.scans(3).check("D8013=2").set("D8013=30").scans(1).check("D8013=2");
    plc.scan_ms = 1000 * 3600;
    plc.scans(25).set("X0").scans(1).check("D0=0 D1=1 D2=2 D3=1 D4=0 D5=3 D6=0");
}

#[test]
fn the_clock_is_set_frozen_and_rounded() {
    let mut plc = Plc::list("LD X0\nOUT M8015\nLD X1\nOUT M8016\nLD X2\nOUT M8017\nEND\n");
    plc.scan_ms = 1000;
    plc.set("X0").scans(2).set("D8018=99 D8017=12 D8016=31 D8015=23 D8014=59 D8013=58 D8019=5").scans(3);
    plc.check("D8013=58").set("X0=0").scans(2).check("D8013=58 D8018=99 ~M8019");
    plc.scans(3).check("D8018=0 D8017=1 D8016=1 D8015=0 D8014=0 D8013=1 D8019=6");
    plc.set("X1").scans(6).check("D8013=2").set("X1=0").scans(2).check("D8013=9");
    plc.set("X2").scans(2).check("D8014=0 D8013=0").scans(35).check("D8013=35");
    plc.set("X2=0").scans(1).set("X2").scans(2).check("D8014=1 D8013=0");
    plc.set("X0")
        .scans(1)
        .set("D8017=2 D8016=30")
        .scans(1)
        .set("X0=0")
        .scans(2)
        .check("M8019 D8017=1 D8016=1");
    plc.set("X0").scans(1).set("D8016=31 X0=0").scans(2).check("~M8019 D8016=31");
}

#[test]
fn the_clock_knows_leap_years_and_shows_four_digits_on_demand() {
    let mut plc = Plc::list("LD M8002\nMOV K2000 D8018\nLD X0\nTWRP D0\nLD M8000\nTRD D10\nEND\n");
    plc.scan_ms = 1000;
    plc.scans(2).check("D8018=2000");
    for (date, next) in [
        ("D0=24 D1=2 D2=28 D6=3", "D10=2024 D11=2 D12=29 D16=4"),
        ("D0=2023 D1=2 D2=28 D6=2", "D10=2023 D11=3 D12=1 D16=3"),
        ("D0=24 D1=4 D2=30 D6=6", "D10=2024 D11=5 D12=1 D16=0"),
        ("D0=1999 D1=12 D2=31 D6=5", "D10=2000 D11=1 D12=1 D16=6"),
        ("D0=79 D1=12 D2=31 D6=0", "D10=1980 D11=1 D12=1 D16=1"),
    ] {
        plc.set("D3=23 D4=59 D5=59 X0=0").set(date).scans(1).set("X0").scans(2).check(next);
        plc.check("D13=0 D14=0 D15=0");
    }
}
