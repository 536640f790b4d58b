//! Instruction List of IEC 61131-3: trees, problems, chunks, mentions and formatting.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use expect_test::{Expect, expect};
use proptest::prelude::*;
use rungwise::il::iec::{
    Condition, Declaration, Direction, FormatOptions, IecTree, InitialValue, ItemKind, ListForm, OperandId,
    Parameter, ParameterValue, Run, TypeId, TypeSpec, ValueKind, fold_case, format_chunk, parse, same_name,
    split,
};
use rungwise::target::{Model, Operand, Target};
use rungwise::text::{Language, Severity, Span};
use std::fmt::Write;

fn iec() -> &'static Target {
    Target::of(Model::Iec)
}

/// Reads `text` as one chunk and compares what it says, its problems with their places included.
fn check(text: &str, expected: Expect) {
    let tree = parse(text, iec());
    assert_spans_in_range(text, &tree);
    expected.assert_eq(&dump(text, &tree));
}

fn dump(text: &str, tree: &IecTree) -> String {
    let mut out = String::new();
    for item in &tree.items {
        let indent = "  ".repeat(item.depth as usize);
        writeln!(out, "{indent}{}", Dump { text, tree }.item(&item.kind)).unwrap();
    }
    out + &problems(text, tree)
}

fn problems(text: &str, tree: &IecTree) -> String {
    let mut out = String::new();
    for problem in &tree.problems {
        let grave = if problem.severity == Severity::Hint { "hint" } else { "error" };
        let place = position(text, problem.span.start as usize);
        let word = problem.span.of(text).replace('\n', "⏎");
        let message = problem.message.render(Language::English);
        writeln!(out, "{grave} {place} `{word}` {}: {message}", problem.code).unwrap();
        for related in &problem.related {
            let place = position(text, related.span.start as usize);
            writeln!(out, "  {place} {}", related.message.render(Language::English)).unwrap();
        }
    }
    out
}

fn position(text: &str, offset: usize) -> String {
    let head = &text[..offset];
    let line = head.matches('\n').count() + 1;
    format!("{line}:{}", head.rsplit('\n').next().unwrap().chars().count() + 1)
}

struct Dump<'a> {
    text: &'a str,
    tree: &'a IecTree,
}

impl Dump<'_> {
    fn item(&self, kind: &ItemKind) -> String {
        match *kind {
            ItemKind::Pou { kind, name, result } => {
                let result = result.map_or(String::new(), |id| format!(" : {}", self.type_spec(id)));
                format!("{kind:?} {}{result}", self.name(name))
            }
            ItemKind::PouEnd(kind) => format!("end {kind:?}"),
            ItemKind::Section { kind, constant, retain, declarations } => {
                let constant = if constant { " constant" } else { "" };
                let retain = match retain {
                    Some(true) => " retain",
                    Some(false) => " non-retain",
                    None => "",
                };
                format!("section {kind:?}{constant}{retain}{}", self.declarations(declarations))
            }
            ItemKind::Types { declarations } => format!("types{}", self.declarations(declarations)),
            ItemKind::Configuration { name } => format!("configuration {}", self.name(name)),
            ItemKind::Resource { name, on } => format!("resource {} on {}", self.name(name), self.name(on)),
            ItemKind::Task(index) => {
                let task = self.tree.tasks[index as usize];
                let mut line = format!("task {}", self.name(task.name));
                for (word, value) in
                    [("single", task.single), ("interval", task.interval), ("priority", task.priority)]
                {
                    if let Some(value) = value {
                        write!(line, " {word}={}", self.operand(value)).unwrap();
                    }
                }
                line
            }
            ItemKind::Instance(index) => {
                let instance = self.tree.instances[index as usize];
                let mut line = format!(
                    "instance {} with {} : {}",
                    self.name(instance.name),
                    self.name(instance.task),
                    self.name(instance.program)
                );
                write!(line, "{}", self.parameters(instance.parameters)).unwrap();
                for pair in instance.block_tasks.of(&self.tree.names).chunks(2) {
                    write!(line, " [{} with {}]", self.word(pair[0]), self.word(pair[1])).unwrap();
                }
                line
            }
            ItemKind::End(keyword) => format!("end {keyword:?}"),
            ItemKind::Label { name } => format!("label {}", self.word(name)),
            ItemKind::Operation { operation, operand } => {
                let negated = if operation.negated { " not" } else { "" };
                format!("{}{negated} {}", operation.operator.name, self.maybe(operand))
            }
            ItemKind::Open { operation, operand } => {
                let negated = if operation.negated { " not" } else { "" };
                format!("{}{negated} ( {}", operation.operator.name, self.maybe(operand))
            }
            ItemKind::Close => ")".to_string(),
            ItemKind::Jump { condition, label, .. } => {
                format!("jump{} {}", self.condition(condition), self.name(label))
            }
            ItemKind::Return { condition, .. } => format!("return{}", self.condition(condition)),
            ItemKind::Call { condition, callee, form, parameters, .. } => format!(
                "call{} {}{}{}",
                self.condition(condition),
                self.maybe(callee),
                self.form(form),
                self.parameters(parameters)
            ),
            ItemKind::Function { name, form, parameters } => {
                format!("function {}{}{}", self.word(name), self.form(form), self.parameters(parameters))
            }
            ItemKind::InputOperator { input, instance } => {
                format!("input {} of {}", self.word(input), self.operand(instance))
            }
            ItemKind::ParameterOpen { parameter } => {
                format!("( for {}", self.name(self.tree.parameters[parameter as usize].name))
            }
        }
    }

    fn word(&self, span: Span) -> String {
        span.of(self.text).to_string()
    }

    fn name(&self, span: Option<Span>) -> String {
        span.map_or("?".to_string(), |span| self.word(span))
    }

    fn maybe(&self, operand: Option<OperandId>) -> String {
        operand.map_or("-".to_string(), |operand| self.operand(operand))
    }

    fn operand(&self, id: OperandId) -> String {
        let operand = self.tree.operand(id);
        let word = self.word(operand.span);
        match operand.value {
            Operand::Variable => word,
            Operand::Literal(_) => format!("={word}"),
            Operand::Direct(_) => format!("@{word}"),
            Operand::Invalid(problem) => format!("{word}!{problem:?}"),
            other => format!("{word}?{other:?}"),
        }
    }

    fn condition(&self, condition: Condition) -> &'static str {
        match condition {
            Condition::Always => "",
            Condition::IfTrue => " if true",
            Condition::IfFalse => " if false",
        }
    }

    fn form(&self, form: ListForm) -> &'static str {
        match form {
            ListForm::None => "",
            ListForm::NonFormal => " in order",
            ListForm::Formal => " by name",
        }
    }

    fn parameters(&self, run: Run) -> String {
        let mut out = String::new();
        for parameter in run.of(&self.tree.parameters) {
            write!(out, " [{}]", self.parameter(parameter)).unwrap();
        }
        out
    }

    fn parameter(&self, parameter: &Parameter) -> String {
        let value = match parameter.value {
            ParameterValue::Operand(operand) => self.operand(operand),
            ParameterValue::Instructions => "( )".to_string(),
            ParameterValue::Missing => "missing".to_string(),
        };
        let Some(name) = parameter.name else { return value };
        match parameter.direction {
            Direction::In => format!("{} := {value}", self.word(name)),
            Direction::Out { negated: false } => format!("{} => {value}", self.word(name)),
            Direction::Out { negated: true } => format!("not {} => {value}", self.word(name)),
        }
    }

    fn declarations(&self, run: Run) -> String {
        let mut out = String::new();
        for declaration in run.of(&self.tree.declarations) {
            write!(out, "\n  {}", self.declaration(declaration)).unwrap();
        }
        out
    }

    fn declaration(&self, declaration: &Declaration) -> String {
        let names: Vec<String> =
            declaration.names.of(&self.tree.names).iter().map(|name| self.word(*name)).collect();
        let mut out = names.join(",");
        if let Some(path) = declaration.path {
            write!(out, " path {}", self.word(path)).unwrap();
        }
        if let Some(address) = declaration.address {
            write!(out, " at {}", self.operand(address)).unwrap();
        }
        let declared = declaration.declared.map_or("?".to_string(), |id| self.type_spec(id));
        write!(out, " : {declared}").unwrap();
        if let Some(edge) = declaration.edge {
            write!(out, " {edge:?}").unwrap();
        }
        if let Some(writable) = declaration.writable {
            write!(out, " writable={writable}").unwrap();
        }
        if let Some(initial) = declaration.initial {
            write!(out, " := {}", self.value(initial)).unwrap();
        }
        out
    }

    fn type_spec(&self, id: TypeId) -> String {
        let written = self.tree.type_spec(id);
        match written.value {
            TypeSpec::Elementary(kind) => format!("{kind:?}"),
            TypeSpec::Named => format!("'{}'", self.word(written.span)),
            TypeSpec::Text { wide, length } => format!("text(wide={wide}, {})", self.operand(length)),
            TypeSpec::Subrange { base, least, greatest } => {
                format!("{}({}..{})", self.type_spec(base), self.operand(least), self.operand(greatest))
            }
            TypeSpec::Enumeration { values } => {
                let values: Vec<String> =
                    values.of(&self.tree.names).iter().map(|name| self.word(*name)).collect();
                format!("enum({})", values.join(","))
            }
            TypeSpec::Array { bounds, element } => {
                let bounds: Vec<String> =
                    (bounds.start..bounds.end).map(|bound| self.operand(OperandId(bound))).collect();
                format!("array[{}] of {}", bounds.join(","), self.type_spec(element))
            }
            TypeSpec::Structure { fields } => {
                let fields: Vec<String> =
                    fields.of(&self.tree.declarations).iter().map(|field| self.declaration(field)).collect();
                format!("struct{{{}}}", fields.join("; "))
            }
            TypeSpec::Reference { target } => format!("ref {}", self.type_spec(target)),
        }
    }

    fn value(&self, index: u32) -> String {
        let value: InitialValue = self.tree.values[index as usize];
        let inside: Vec<String> = self.tree.values_inside(index).map(|at| self.value(at)).collect();
        let inside = inside.join(",");
        let field = value.field.map_or(String::new(), |field| format!("{}:=", self.word(field)));
        match value.kind {
            ValueKind::Constant(operand) => format!("{field}{}", self.operand(operand)),
            ValueKind::Array => format!("{field}[{inside}]"),
            ValueKind::Repeat { count } => format!("{field}{}({inside})", self.operand(count)),
            ValueKind::Structure => format!("{field}({inside})"),
        }
    }
}

/// Every span of the tree lies in the text and on character boundaries.
fn assert_spans_in_range(text: &str, tree: &IecTree) {
    let mut spans: Vec<Span> = tree.items.iter().map(|item| item.span).collect();
    spans.extend(tree.operands.iter().map(|operand| operand.span));
    spans.extend(tree.parameters.iter().map(|parameter| parameter.span));
    spans.extend(tree.declarations.iter().map(|declaration| declaration.span));
    spans.extend(tree.types.iter().map(|written| written.span));
    spans.extend(tree.values.iter().map(|value| value.span));
    spans.extend(&tree.names);
    spans.extend(&tree.comments);
    spans.extend(&tree.pragmas);
    spans.extend(tree.mentions(text).map(|mention| mention.span));
    for problem in &tree.problems {
        spans.push(problem.span);
        spans.extend(problem.related.iter().map(|related| related.span));
    }
    for span in spans {
        assert!(text.get(span.range()).is_some(), "{span:?} is not in the text of {} bytes", text.len());
    }
}

#[test]
fn simple_instructions() {
    check(
        "LD a\nANDN %IX0.1\nST\tb (* c *)\nNOT\n\nS m\nR m\nld T1.Q\n&n x\nST? y\n",
        expect![[r#"
        LD a
        AND not @%IX0.1
        ST b
        NOT -
        S m
        R m
        LD T1.Q
        & not x
        ST y
    "#]],
    );
    check(
        "start: LD 5\nGT 16#FF\nlone:\nJMPC start\njmpcn lone\nJMP start\nRET\nRETC\nRETCN\n",
        expect![[r#"
        label start
        LD =5
        GT =16#FF
        label lone
        jump if true start
        jump if false lone
        jump start
        return
        return if true
        return if false
    "#]],
    );
    check(
        "LD a[3].b\nADD a[i, 2].c[b[1]]\nLD p^\nLD w.3\nLD w.%X3\nLD Colour#Red\nLD T#1h30m\nLD -5\n",
        expect![[r#"
        LD a[3].b
        ADD a[i, 2].c[b[1]]
        LD p^
        LD w.3
        LD w.%X3
        LD =Colour#Red
        LD =T#1h30m
        LD =-5
    "#]],
    );
}

#[test]
fn parentheses() {
    check(
        "LD a\nAND(\nLD b\nORN c\n)\nST d\n",
        expect![[r#"
        LD a
        AND ( -
          LD b
          OR not c
        )
        ST d
    "#]],
    );
    check(
        "LD a\nANDN( b\nOR( c\nXOR d\n)\n)\nGT( 5\n)\n",
        expect![[r#"
        LD a
        AND not ( b
          OR ( c
            XOR d
          )
        )
        GT ( =5
        )
    "#]],
    );
    check(
        "LD a\nAND( b\nOR c)\nAND(LD x\nOR y\n)\nADD(AND(LD z\n)\n)\n",
        expect![[r#"
        LD a
        AND ( b
          OR c
        )
        AND ( -
          LD x
          OR y
        )
        ADD ( -
          AND ( -
            LD z
          )
        )
        hint 3:5 `)` lenient-form: the standard puts this parenthesis on a line of its own
        hint 4:5 `LD` lenient-form: the standard starts a new line after this parenthesis
        hint 7:5 `AND` lenient-form: the standard starts a new line after this parenthesis
        hint 7:9 `LD` lenient-form: the standard starts a new line after this parenthesis
    "#]],
    );
}

#[test]
fn calls_of_blocks() {
    check(
        "CAL T1\nCALC T1\nCALCN a.b[2]\n",
        expect![[r#"
        call T1
        call if true T1
        call if false a.b[2]
    "#]],
    );
    check(
        "CAL C10(%IX10, FALSE, A, OUT, B)\n",
        expect![[r#"
        call C10 in order [@%IX10] [=FALSE] [A] [OUT] [B]
    "#]],
    );
    check(
        "CAL T1(\nIN := a,\nPT := T#1s,\nR := r,\nNOT Q => b.c,\nET => d\n)\nLD T1.Q\n",
        expect![[r#"
        call T1 by name [IN := a] [PT := =T#1s] [R := r] [not Q => b.c] [ET => d]
        LD T1.Q
    "#]],
    );
    check(
        "CALC T1(\nIN := (\nLD a\nAND( b\nOR c\n)\nLIMIT(\nMN := (\nLD 1\n),\nIN := 2\n)\n),\nPT := t\n)\nST q\n",
        expect![[r#"
            call if true T1 by name [IN := ( )] [PT := t]
              ( for IN
                LD a
                AND ( b
                  OR c
                )
                function LIMIT by name [MN := ( )] [IN := =2]
                  ( for MN
                    LD =1
                  )
              )
            ST q
        "#]],
    );
    check(
        "LD 15\nPV C10\nCU C10\nS1 latch\nCLK edge\nR C10\n",
        expect![[r#"
        LD =15
        input PV of C10
        input CU of C10
        input S1 of latch
        input CLK of edge
        R C10
    "#]],
    );
    check(
        "CAL T1()\nCAL T1(\n)\n",
        expect![[r#"
        call T1 by name
        call T1 by name
    "#]],
    );
}

#[test]
fn calls_of_functions() {
    check(
        "LD 1\nLIMIT B, 5\nSHL 3\nINT_TO_REAL\nADD a, b, 3\nFB.M1 a\n",
        expect![[r#"
        LD =1
        function LIMIT [B] [=5]
        function SHL [=3]
        function INT_TO_REAL
        function ADD [a] [b] [=3]
        function FB.M1 [a]
    "#]],
    );
    check(
        "LIMIT(\nEN := c,\nMN := 1,\nIN := B,\nMX := 5,\nENO => ok\n)\nST A\n",
        expect![[r#"
        function LIMIT by name [EN := c] [MN := =1] [IN := B] [MX := =5] [ENO => ok]
        ST A
    "#]],
    );
    check(
        "ADD(\nIN1 := a,\nIN2 := b\n)\nNOT(\nIN := a\n)\nMOD( 3\n)\n",
        expect![[r#"
        function ADD by name [IN1 := a] [IN2 := b]
        function NOT by name [IN := a]
        MOD ( =3
        )
    "#]],
    );
}

#[test]
fn lenient_lists() {
    check(
        "CAL T1(IN := a, PT := T#1s)\nCAL T1(\nIN := a,\nPT := b)\n",
        expect![[r#"
        call T1 by name [IN := a] [PT := =T#1s]
        call T1 by name [IN := a] [PT := b]
        hint 1:7 `(` lenient-form: the standard puts each named parameter and the closing parenthesis on a line of its own
        hint 4:8 `)` lenient-form: the standard puts each named parameter and the closing parenthesis on a line of its own
    "#]],
    );
    check(
        "CAL T1(a,\nb)\nLIMIT(1, B, 5)\nADD(a, b)\nCAL LIMIT(MN:=1,IN:=N,MX:=128)\n",
        expect![[r#"
        call T1 in order [a] [b]
        function LIMIT in order [=1] [B] [=5]
        function ADD in order [a] [b]
        call LIMIT by name [MN := =1] [IN := N] [MX := =128]
        hint 1:9 `,` lenient-form: the standard puts a list of operands on one line
        hint 3:6 `(` lenient-form: the standard writes the operands of a function without parentheses, the first of them being the current result
        hint 4:4 `(` lenient-form: the standard writes the operands of a function without parentheses, the first of them being the current result
        hint 5:5 `LIMIT` lenient-form: the second edition has CAL for function blocks only; a function is called by its name
        hint 5:10 `(` lenient-form: the standard puts each named parameter and the closing parenthesis on a line of its own
    "#]],
    );
    check(
        "LD a;\nST b ; write it\n; a whole line\nLD c;ST d;\n",
        expect![[r#"
            LD a
            ST b
            LD c
            ST d
            hint 1:5 `;` lenient-form: no `;` belongs here
            hint 2:6 `;` lenient-form: read as a comment; the standard has `(* *)` and `//`
            hint 3:1 `;` lenient-form: read as a comment; the standard has `(* *)` and `//`
            hint 4:5 `;` lenient-form: no `;` belongs here
            hint 4:10 `;` lenient-form: no `;` belongs here
        "#]],
    );
    check(
        "LD a // E3\n/* E3 /* nested */ */ ST b\n(* (* nested *) *)\n{pragma}\nLD {x} c\n",
        expect![[r#"
        LD a
        ST b
        LD c
    "#]],
    );
}

#[test]
fn units_and_sections() {
    check(
        "PROGRAM Main\nEND_PROGRAM\nfunction_block FB\nend_function_block\n",
        expect![[r#"
        Program Main
        end Program
        FunctionBlock FB
        end FunctionBlock
    "#]],
    );
    check(
        "FUNCTION F : INT\nVAR_INPUT a : INT; END_VAR\nLD a\nST F\nEND_FUNCTION\n",
        expect![[r#"
        Function F : Int
        section Input
          a : Int
        LD a
        ST F
        end Function
    "#]],
    );
    check(
        "FUNCTION G : STRING[20]\nLD 'x'\nST G\nEND_FUNCTION\nFUNCTION H\nEND_FUNCTION\n",
        expect![[r#"
        Function G : text(wide=false, =20)
        LD ='x'
        ST G
        end Function
        Function H
        end Function
    "#]],
    );
    check(
        "VAR\n  a, b : BOOL := TRUE;\n  x AT %IX0.0 : BOOL;\n  AT %QW1 : INT;\n  t1 : TON := (PT := T#5s);\nEND_VAR\n",
        expect![[r#"
            section Local
              a,b : Bool := =TRUE
              x at @%IX0.0 : Bool
               at @%QW1 : Int
              t1 : 'TON' := (PT:==T#5s)
        "#]],
    );
    check(
        "VAR_INPUT RETAIN a : INT; clk : BOOL R_EDGE; n : BOOL F_EDGE; END_VAR\nVAR_OUTPUT NON_RETAIN q : REAL := 1.5E-3; END_VAR\nVAR_IN_OUT io : LREAL; END_VAR\nVAR_TEMP t : TIME; END_VAR\nVAR_EXTERNAL CONSTANT c : DT; END_VAR\nVAR CONSTANT k : INT := 5; END_VAR\nVAR_GLOBAL RETAIN g : WORD; END_VAR\n",
        expect![[r#"
            section Input retain
              a : Int
              clk : Bool Rising
              n : Bool Falling
            section Output non-retain
              q : Real := =1.5E-3
            section InOut
              io : Lreal
            section Temporary
              t : Time
            section External constant
              c : DateAndTime
            section Local constant
              k : Int := =5
            section Global retain
              g : Word
        "#]],
    );
    check(
        "VAR_ACCESS a : r1.p1.x : BOOL READ_WRITE; b : %IX1.1 : BOOL; c : p.y[1] : INT READ_ONLY; END_VAR\nVAR_CONFIG r1.p1.f.x AT %QX0.1 : BOOL := 1; END_VAR\n",
        expect![[r#"
            section Access
              a path r1.p1.x : Bool writable=true
              b path %IX1.1 : Bool
              c path p.y[1] : Int writable=false
            section Config
               path r1.p1.f.x at @%QX0.1 : Bool := =1
        "#]],
    );
}

#[test]
fn types() {
    check(
        "TYPE\n  Alias : INT;\n  Small : INT(0..9) := 3;\n  Colour : (Red, Green) := Red;\n  A : ARRAY[0..3, 1..N] OF Colour := [2(Red), Green, 1()];\n  P : STRUCT x, y : INT := 1; in : STRUCT z : STRING[5]; END_STRUCT; END_STRUCT := (x := 1, in := (z := 'a'));\n  W : WSTRING(20);\n  R : REF_TO INT;\nEND_TYPE\n",
        expect![[r#"
            types
              Alias : Int
              Small : Int(=0..=9) := =3
              Colour : enum(Red,Green) := Red
              A : array[=0,=3,=1,N] of 'Colour' := [=2(Red),Green,=1()]
              P : struct{x,y : Int := =1; in : struct{z : text(wide=false, =5)}} := (x:==1,in:=(z:=='a'))
              W : text(wide=true, =20)
              R : ref Int
            hint 7:14 `(20)` lenient-form: the standard writes the length of a text in brackets: `STRING[20]`
        "#]],
    );
    check(
        "VAR a : ARRAY[-5..5] OF ARRAY[1..2] OF BOOL := 1, 3(0); s : (A, B); l : lib.Name; i : INT := INT#-5; END_VAR\n",
        expect![[r#"
            section Local
              a : array[=-5,=5] of array[=1,=2] of Bool := [=1,=3(=0)]
              s : enum(A,B)
              l : 'lib.Name'
              i : Int := =INT#-5
            hint 1:48 `1, 3(0)` lenient-form: the standard writes the values of an array in brackets: `[1, 2, 3]`
        "#]],
    );
}

#[test]
fn configurations() {
    check(
        "CONFIGURATION c\nVAR_GLOBAL g AT %MW1 : INT; END_VAR\nRESOURCE r ON cpu\nVAR_GLOBAL h : BOOL; END_VAR\nTASK fast(SINGLE := g.x, INTERVAL := T#10ms, PRIORITY := 0);\nTASK slow(INTERVAL := T#1s, PRIORITY := 9);\nPROGRAM RETAIN p WITH fast : Main(in := h, %IX1.0 := g, out => g, f WITH slow);\nPROGRAM q : Main;\nEND_RESOURCE\nVAR_ACCESS a : r.p.x : BOOL; END_VAR\nEND_CONFIGURATION\n",
        expect![[r#"
            configuration c
            section Global
              g at @%MW1 : Int
            resource r on cpu
            section Global
              h : Bool
            task fast single=g.x interval==T#10ms priority==0
            task slow interval==T#1s priority==9
            instance p with fast : Main
            instance q with ? : Main
            end Resource
            section Access
              a path r.p.x : Bool
            end Configuration
            error 7:44 `%IX1.0` syntax-error: expected identifier, found `%IX1.0`
        "#]],
    );
    check(
        "CONFIGURATION c\nTASK t(INTERVAL := T#1s);\nPROGRAM p WITH t : Main;\nEND_CONFIGURATION\n",
        expect![[r#"
        configuration c
        task t interval==T#1s
        instance p with t : Main
        end Configuration
        hint 2:6 `t` lenient-form: a task needs a PRIORITY; 0 is the most urgent
    "#]],
    );
}

#[test]
fn mistakes_in_bodies() {
    check(
        "LD a b\n10: LD a\nx := 1;\n5\nLD (a\n)\nJMP\nJMP 5\nCAL\nRET x\n)\nST c\n",
        expect![[r#"
            LD a
            LD a
            LD ( a
            )
            jump ?
            jump ?
            call -
            return
            ST c
            error 1:6 `b` syntax-error: expected end of line, found `b`
            error 2:1 `10` syntax-error: a label of Instruction List is a name, not a number
            error 3:3 `:=` syntax-error: expected operand, `(` or end of line, found `:=`
            error 4:1 `5` syntax-error: expected instruction, found `5`
            error 5:4 `(` syntax-error: LD takes no parenthesis
            error 7:4 `` syntax-error: expected label
            error 8:5 `5` syntax-error: a label of Instruction List is a name, not a number
            error 9:4 `` syntax-error: expected function block instance
            error 10:5 `x` syntax-error: expected end of line, found `x`
            error 11:1 `)` syntax-error: `)` without `(`
        "#]],
    );
    check(
        "LD VAR_X\nLD ON\nst: ST a.\nLD a[1\nLD a__b\nx__y: LD 1e3\nJMP retain\nLD §$ a\nST 'abc\n",
        expect![[r#"
            LD VAR_X
            LD ON!Keyword
            label st
            ST a.
            LD a[1
            LD a__b!MalformedName
            label x__y
            LD 1e3!MalformedLiteral(RealForm)
            jump retain
            LD -
            ST 'abc!MalformedLiteral(Text)
            error 3:10 `` syntax-error: expected identifier
            error 4:7 `` syntax-error: expected ]
            error 6:1 `x__y` syntax-error: `x__y` cannot be a name: it may not start with a digit, end in `_` or hold two `_` side by side
            error 7:5 `retain` syntax-error: RETAIN is a reserved word and cannot be a name
            error 8:4 `§` syntax-error: expected operand, found `§`
        "#]],
    );
    check(
        "LD a\nAND(\nLD b\nJMP x\ny: LD c\nCAL T\nRET\n)\nST d\n",
        expect![[r#"
        LD a
        AND ( -
          LD b
          jump x
          label y
          LD c
          call T
          return
        )
        ST d
        error 4:1 `JMP` syntax-error: labels, JMP, CAL and RET cannot stand inside parentheses
        error 5:1 `y` syntax-error: labels, JMP, CAL and RET cannot stand inside parentheses
        error 6:1 `CAL` syntax-error: labels, JMP, CAL and RET cannot stand inside parentheses
        error 7:1 `RET` syntax-error: labels, JMP, CAL and RET cannot stand inside parentheses
    "#]],
    );
    check(
        "LD a\nAND(\nLD b\nJMP x\nLD c\n",
        expect![[r#"
        LD a
        AND ( -
          LD b
        jump x
        LD c
        error 2:4 `(` unclosed-parenthesis: this parenthesis is not closed
    "#]],
    );
    check(
        "CAL T1(\nIN := a,\nLD b\nST c\n",
        expect![[r#"
        call T1 by name [IN := a]
        LD b
        ST c
        error 1:7 `(` unclosed-parenthesis: this parenthesis is not closed
    "#]],
    );
    check(
        "CAL T1(\nIN := a\nPT := b,\n)\nCAL T2(IN := , PT = 5)\nCAL T3(IN := a, 5)\nCAL T4(5, IN := a)\nLD x\n",
        expect![[r#"
            call T1 by name [IN := a] [PT := b]
            call T2 by name [IN := missing] [PT]
            call T3 by name [IN := a] [=5]
            call T4 in order [=5] [IN := a]
            LD x
            error 2:8 `` syntax-error: expected `,` or `)`
            error 4:1 `)` syntax-error: expected parameter, found `)`
            hint 5:7 `(` lenient-form: the standard puts each named parameter and the closing parenthesis on a line of its own
            error 5:14 `,` syntax-error: expected operand or `(`, found `,`
            error 5:19 `=` syntax-error: expected `:=` or `=>`, found `=`
            hint 6:7 `(` lenient-form: the standard puts each named parameter and the closing parenthesis on a line of its own
            error 6:18 `)` syntax-error: expected `:=` or `=>`, found `)`
            error 7:14 `:=` syntax-error: expected `,` or `)`, found `:=`
        "#]],
    );
    check(
        "AND( CAL T1(\nIN := (\nLD a\nEND_PROGRAM\nLD b\nEND_VAR\nLD c\nLIMIT a,\n",
        expect![[r#"
        AND ( -
        call T1 by name [IN := ( )]
          ( for IN
            LD a
        end Program
        LD b
        LD c
        function LIMIT [a]
        error 1:4 `(` unclosed-parenthesis: this parenthesis is not closed
        hint 1:6 `CAL` lenient-form: the standard starts a new line after this parenthesis
        error 1:12 `(` unclosed-parenthesis: this parenthesis is not closed
        error 2:7 `(` unclosed-parenthesis: this parenthesis is not closed
        error 6:1 `END_VAR` syntax-error: expected instruction, found `END_VAR`
        error 8:9 `` syntax-error: expected operand
    "#]],
    );
    check(
        "(* never\n(* closed *)\nLD a\n",
        expect![[r#"
        error 1:1 `(*` unclosed-comment: this comment does not end
          2:1 comments nest; this one inside may lack its end
    "#]],
    );
    check(
        "LD a\n{never\nLD b",
        expect![[r#"
        LD a
        error 2:1 `{` unclosed-comment: this pragma does not end: `}` expected
    "#]],
    );
}

#[test]
fn mistakes_in_declarations() {
    check(
        "VAR\n  a : BOOL\n  b : INT;\n  c INT;\n  d : ;\n  e : INT = 5;\n  x__y, on : BOOL;\n  f : INT;\nEND_VAR;\n",
        expect![[r#"
            section Local
              a : Bool
              b : Int
              c : ?
              d : ?
              e : ?
              x__y : ?
              f : Int
            error 2:11 `` syntax-error: expected `;`
            error 4:5 `INT` syntax-error: expected `,`, `:` or `AT`, found `INT`
            error 5:7 `;` syntax-error: expected type, found `;`
            error 6:11 `=` syntax-error: expected `(`, `;`, `:=`, `.`, `R_EDGE` or `F_EDGE`, found `=`
            error 7:3 `x__y` syntax-error: `x__y` cannot be a name: it may not start with a digit, end in `_` or hold two `_` side by side
            error 7:9 `on` syntax-error: ON is a reserved word and cannot be a name
            hint 9:8 `;` lenient-form: no `;` belongs here
        "#]],
    );
    check(
        "VAR\n  a : BOOL;\nLD a\nST b\nEND_PROGRAM\n",
        expect![[r#"
        section Local
          a : Bool
        LD a
        ST b
        end Program
        error 1:1 `VAR` syntax-error: VAR lacks its END_VAR
    "#]],
    );
    check(
        "VAR\n  a : BOOL;\nVAR_INPUT\n  b : BOOL;\nPROGRAM p\nTYPE t : INT;\nPROGRAM q\n",
        expect![[r#"
        section Local
          a : Bool
        section Input
          b : Bool
        Program p
        types
          t : Int
        Program q
        error 1:1 `VAR` syntax-error: VAR lacks its END_VAR
        error 3:1 `VAR_INPUT` syntax-error: VAR_INPUT lacks its END_VAR
        error 6:1 `TYPE` syntax-error: TYPE lacks its END_TYPE
    "#]],
    );
    check(
        "TYPE\n  s : STRUCT a : INT; b c; d : BOOL; END_STRUCT;\n  t : ARRAY[1..] OF INT;\n  u : INT;\nEND_TYPE\n",
        expect![[r#"
            types
              s : struct{a : Int; d : Bool}
              t : ?
              u : Int
            error 2:25 `c` syntax-error: expected `,`, `:` or `AT`, found `c`
            error 3:16 `]` syntax-error: expected value, found `]`
        "#]],
    );
    check(
        "PROGRAM\nPROGRAM var_x;\nFUNCTION 5\nFUNCTION f :\nEND_FUNCTION x\nPROGRAM type\n",
        expect![[r#"
            Program ?
            Program var_x
            Function ?
            Function f
            end Function
            Program type
            error 1:8 `` syntax-error: expected identifier
            hint 2:14 `;` lenient-form: no `;` belongs here
            error 3:10 `5` syntax-error: expected identifier, found `5`
            error 4:13 `` syntax-error: expected type
            error 5:14 `x` syntax-error: expected end of line, found `x`
            error 6:9 `type` syntax-error: TYPE is a reserved word and cannot be a name
        "#]],
    );
    check(
        "CONFIGURATION\nRESOURCE r\nTASK t(PRIO := 1, PRIORITY := 2)\nPROGRAM p WITH : Main;\nLD a\nPROGRAM q WITH t : Main\nVAR_GLOBAL a : BOOL;\n",
        expect![[r#"
            configuration ?
            resource r on ?
            task t priority==2
            instance q with t : Main
            section Global
              a : Bool
            error 1:1 `CONFIGURATION` syntax-error: CONFIGURATION lacks its END_CONFIGURATION
            error 1:14 `` syntax-error: expected identifier
            error 2:1 `RESOURCE` syntax-error: RESOURCE lacks its END_RESOURCE
            error 2:11 `` syntax-error: expected `ON`
            error 3:8 `PRIO` syntax-error: expected `SINGLE`, `INTERVAL` or `PRIORITY`, found `PRIO`
            error 3:33 `` syntax-error: expected `;`
            error 4:16 `:` syntax-error: expected identifier, found `:`
            error 5:1 `LD` syntax-error: expected `VAR_GLOBAL`, `RESOURCE`, `TASK`, `PROGRAM`, `VAR_ACCESS`, `VAR_CONFIG` or `END_CONFIGURATION`, found `LD`
            error 6:24 `` syntax-error: expected `(`, `;` or `.`
            error 7:1 `VAR_GLOBAL` syntax-error: VAR_GLOBAL lacks its END_VAR
        "#]],
    );
}

/// Cuts `text` and shows the chunks with a line between them.
fn check_split(text: &str, expected: Expect) {
    expected.assert_eq(&chunks(text).join("────\n"));
}

fn chunks(text: &str) -> Vec<&str> {
    let mut start = 0;
    split(text).into_iter().map(|end| &text[std::mem::replace(&mut start, end)..end]).collect()
}

#[test]
fn chunks_of_a_file() {
    check_split(
        "(* head *)\nPROGRAM p\n\n// inputs\nVAR_INPUT\n  a : BOOL;\nEND_VAR\nVAR x : INT; END_VAR\nCAL T1\nLD a\nST b\n\n(* next *)\n; more\nl1:\n\nLD c\nAND(\nLD d\n)\nST e\nl2: LDN f\nST g\n(* last *)\nEND_PROGRAM\n\n(* own *)\n\nFUNCTION f : INT\nLD 1\nST f\nEND_FUNCTION\nTYPE t : INT; END_TYPE\nCONFIGURATION c\nTASK t(PRIORITY := 1);\nPROGRAM q WITH t : p;\nEND_CONFIGURATION\nLD stray\n",
        expect![[r#"
            (* head *)
            PROGRAM p

            ────
            // inputs
            VAR_INPUT
              a : BOOL;
            END_VAR
            ────
            VAR x : INT; END_VAR
            ────
            CAL T1
            ────
            LD a
            ST b

            ────
            (* next *)
            ; more
            l1:

            LD c
            AND(
            LD d
            )
            ST e
            ────
            l2: LDN f
            ST g
            (* last *)
            END_PROGRAM

            (* own *)

            ────
            FUNCTION f : INT
            ────
            LD 1
            ST f
            END_FUNCTION
            ────
            TYPE t : INT; END_TYPE
            ────
            CONFIGURATION c
            TASK t(PRIORITY := 1);
            PROGRAM q WITH t : p;
            END_CONFIGURATION
            ────
            LD stray
        "#]],
    );
    check_split(
        "VAR\n a : BOOL;\nLD a\nST b\nVAR\n LD : BOOL;\nPROGRAM p\nCONFIGURATION c\nPROGRAM p\nLD x\nTYPE\nFUNCTION f\n",
        expect![[r#"
        VAR
         a : BOOL;
        ────
        LD a
        ST b
        ────
        VAR
         LD : BOOL;
        ────
        PROGRAM p
        ────
        CONFIGURATION c
        ────
        PROGRAM p
        ────
        LD x
        ────
        TYPE
        ────
        FUNCTION f
    "#]],
    );
    check_split(
        "CAL T1(\nLD := a,\nLD b\nST c\nLD d\nAND(\nLD e\nJMP x\nLD f\nADD(\nIN1 := a,\nLD g\nST h\nLD i\n",
        expect![[r#"
        CAL T1(
        LD := a,
        ────
        LD b
        ST c
        ────
        LD d
        AND(
        LD e
        JMP x
        ────
        LD f
        ADD(
        IN1 := a,
        ────
        LD g
        ST h
        ────
        LD i
    "#]],
    );
    check_split(
        "LD a\n(* LD b\nLD c\n*) ST d\n{\nLD e\n}\nLD f\n(* LD g\nLD h\n",
        expect![[r#"
        LD a
        (* LD b
        LD c
        *) ST d
        ────
        {
        LD e
        }
        LD f
        (* LD g
        LD h
    "#]],
    );
    assert_eq!(split(""), [0usize; 0]);
    assert_eq!(split("\n\n"), [2]);
}

const WORDS: &[&str] = &[
    "LD",
    "LDN",
    "ST",
    "AND",
    "AND(",
    "ANDN(",
    "ADD",
    "GT(",
    "NOT",
    "S",
    "R",
    "JMP",
    "JMPC",
    "CAL",
    "CALC",
    "RET",
    "RETCN",
    "(",
    ")",
    ",",
    ";",
    ":",
    ":=",
    "=>",
    "..",
    ".",
    "^",
    "?",
    "[",
    "]",
    "\n",
    "\n",
    "\n",
    "\n",
    "\r\n",
    " ",
    "a",
    "b.c",
    "a[1]",
    "x",
    "lbl:",
    "T1",
    "IN",
    "PT",
    "CU",
    "LIMIT(",
    "LIMIT",
    "5",
    "-3",
    "16#FF",
    "1.",
    ".5",
    "T#1h",
    "'text'",
    "'open",
    "%IX0.0",
    "TRUE",
    "PROGRAM",
    "END_PROGRAM",
    "FUNCTION_BLOCK",
    "END_FUNCTION_BLOCK",
    "FUNCTION",
    "END_FUNCTION",
    "VAR",
    "VAR_INPUT",
    "VAR_ACCESS",
    "VAR_CONFIG",
    "VAR_GLOBAL",
    "END_VAR",
    "CONSTANT",
    "RETAIN",
    "AT",
    "R_EDGE",
    "READ_ONLY",
    "TYPE",
    "END_TYPE",
    "STRUCT",
    "END_STRUCT",
    "ARRAY",
    "OF",
    "REF_TO",
    "STRING",
    "INT",
    "BOOL",
    "CONFIGURATION",
    "END_CONFIGURATION",
    "RESOURCE",
    "END_RESOURCE",
    "ON",
    "TASK",
    "WITH",
    "(* c *)",
    "(*",
    "*)",
    "//",
    "/*",
    "*/",
    "{",
    "}",
    "{p}",
    "; c",
    "§",
    "é",
    "&",
    "#",
    "\u{feff}",
];

/// Words of the language in any order: what a text looks like in the middle of an edit.
fn soup() -> impl Strategy<Value = String> {
    proptest::collection::vec((0..WORDS.len(), proptest::bool::weighted(0.8)), 0..60).prop_map(|words| {
        words
            .iter()
            .map(|(word, blank)| format!("{}{}", WORDS[*word], if *blank { " " } else { "" }))
            .collect()
    })
}

/// Lines that make sense one by one.
const LINES: &[&str] = &[
    "PROGRAM p",
    "END_PROGRAM",
    "VAR",
    "VAR_INPUT",
    "  a, b : BOOL := TRUE;",
    "END_VAR",
    "LD a",
    "LDN b",
    "ST c",
    "AND(",
    "LD d",
    ")",
    "OR( e",
    "CAL T1(",
    "IN := a,",
    "PT := T#5s",
    "l1:",
    "l2: LD f",
    "l3: ST g",
    "JMP l1",
    "RET",
    "",
    "(* c *)",
    "// d",
    "; e",
    "(* f",
    "g *)",
    "{ p }",
    "TYPE",
    "  T : STRUCT x : INT; END_STRUCT;",
    "END_TYPE",
    "CONFIGURATION c",
    "TASK t(PRIORITY := 1);",
    "PROGRAM i WITH t : p;",
    "VAR_GLOBAL",
    "END_CONFIGURATION",
    "FUNCTION f : INT",
    "END_FUNCTION",
    "ADD(",
    "LIMIT(",
    "S1 x",
    "ST c;",
    "LD a;ST b",
    "IN := (",
    "),",
    "NOT Q => z",
    "CAL T1",
    "END_VAR;",
    ".5",
    "a.b",
    "LD",
    "LD (* h *) a (* LD i *)",
];

fn lines() -> impl Strategy<Value = String> {
    proptest::collection::vec(0..LINES.len(), 0..40)
        .prop_map(|lines| lines.iter().map(|line| format!("{}\n", LINES[*line])).collect())
}

fn any_text() -> impl Strategy<Value = String> {
    prop_oneof![soup(), lines(), "\\PC{0,80}", "[ -~\n]{0,120}"]
}

/// What a document does after an edit: it cuts again from the start of the chunk before the first touched one, until a
/// cut of the old text with an untouched chunk behind it comes back.
fn split_incrementally(old: &str, edit: std::ops::Range<usize>, new_text: &str) -> (String, Vec<usize>) {
    let text = format!("{}{}{}", &old[..edit.start], new_text, &old[edit.end..]);
    let old_ends = split(old);
    let starts: Vec<usize> = std::iter::once(0).chain(old_ends.iter().copied()).collect();
    // The chunk that an insertion at its end touches is touched.
    let first = old_ends.iter().position(|end| *end >= edit.start).unwrap_or(0);
    let window = starts[first.saturating_sub(1)];
    let grown = |offset: usize| offset + new_text.len() - edit.len();
    let mut ends: Vec<usize> = old_ends.iter().copied().filter(|end| *end <= window).collect();
    let mut last = old_ends.iter().position(|end| *end > edit.end).unwrap_or(old_ends.len());
    loop {
        // One untouched chunk after the last touched one.
        let limit = old_ends.get(last + 1).copied();
        let window_end = limit.map_or(text.len(), grown);
        let found: Vec<usize> = split(&text[window..window_end]).iter().map(|end| end + window).collect();
        let Some(limit) = limit else {
            ends.extend(found);
            return (text, ends);
        };
        let kept = grown(old_ends[last]);
        if found.contains(&kept) {
            ends.extend(found.iter().take_while(|end| **end <= kept));
            ends.push(grown(limit));
            ends.extend(old_ends[last + 2..].iter().map(|end| grown(*end)));
            return (text, ends);
        }
        last += 1;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn reading_never_fails(text in any_text()) {
        let tree = parse(&text, iec());
        assert_spans_in_range(&text, &tree);
        let ends = split(&text);
        prop_assert!(ends.windows(2).all(|pair| pair[0] < pair[1]));
        prop_assert!(ends.iter().all(|end| text.is_char_boundary(*end)));
        prop_assert_eq!(ends.last().copied().unwrap_or(0), text.len());
        for chunk in chunks(&text) {
            assert_spans_in_range(chunk, &parse(chunk, iec()));
        }
    }

    /// Cutting a chunk and what follows it gives what cutting the whole text gives there.
    #[test]
    fn cuts_depend_on_what_follows_only(text in prop_oneof![lines(), soup()]) {
        let ends = split(&text);
        for (index, end) in ends.iter().enumerate() {
            let behind: Vec<usize> = split(&text[*end..]).iter().map(|later| later + end).collect();
            prop_assert_eq!(&behind, &ends[index + 1..]);
        }
        // And whether a text is cut is known once the chunk behind the cut is.
        for pair in ends.windows(2) {
            let head = split(&text[..pair[1]]);
            prop_assert!(head.contains(&pair[0]), "{:?} {:?}", head, pair);
        }
    }

    #[test]
    fn cuts_can_be_kept_up_to_date(
        old in prop_oneof![lines(), soup()],
        new in prop_oneof![lines(), soup(), Just(String::new())],
        from in any::<prop::sample::Index>(),
        to in any::<prop::sample::Index>(),
    ) {
        let places: Vec<usize> = old.char_indices().map(|(at, _)| at).chain([old.len()]).collect();
        let (from, to) = (*from.get(&places), *to.get(&places));
        let (text, ends) = split_incrementally(&old, from.min(to)..from.max(to), &new);
        prop_assert_eq!(ends, split(&text));
    }
}

#[test]
fn ten_thousand_parentheses() {
    let text = format!("LD a\n{}LD b\n{}ST c\n", "AND(\n".repeat(10_000), ")\n".repeat(10_000));
    let tree = parse(&text, iec());
    assert_eq!(problems(&text, &tree), "");
    assert_eq!(tree.items.len(), 20_003);
    assert_eq!(tree.items.iter().map(|item| item.depth).max(), Some(10_000));
    assert_eq!(split(&text), [text.len()]);
    for text in [
        "AND(".repeat(10_000),
        format!("CAL T({}", "x := (\nLIMIT(\n".repeat(10_000)),
        "LD a[".repeat(10_000),
    ] {
        assert_spans_in_range(&text, &parse(&text, iec()));
    }
    for text in [
        format!("VAR a : {}INT;", "ARRAY[1..2] OF ".repeat(10_000)),
        format!("VAR a : INT := {};", "(x := ".repeat(10_000)),
        format!("VAR a : {}", "STRUCT b : ".repeat(10_000)),
        format!("VAR {}", "a : INT := [[[ ; ".repeat(10_000)),
    ] {
        let tree = parse(&text, iec());
        assert!(!tree.problems.is_empty());
        assert_spans_in_range(&text, &tree);
    }
}

fn formatted(text: &str) -> String {
    let text_of_chunk = |chunk: &&str| format_chunk(chunk, &parse(chunk, iec()), &FormatOptions::default());
    chunks(text).iter().map(text_of_chunk).collect()
}

/// Formats `text` chunk by chunk, as an editor does; the result must have the same tree and be stable.
fn check_format(text: &str, expected: Expect) {
    let result = formatted(text);
    // The bar keeps the indentation, which the macro would take for its own.
    let lines: String = result.split('\n').map(|line| format!("|{line}\n")).collect();
    expected.assert_eq(&lines);
    assert_eq!(formatted(&result), result, "formatting twice changes something");
    assert_eq!(shape(text), shape(&result));
}

/// The items of a text, letter case, blanks inside operands and the fields of spans aside.
fn shape(text: &str) -> String {
    let shapes = chunks(text).into_iter().map(|chunk| {
        let tree = parse(chunk, iec());
        dump(chunk, &IecTree { problems: Vec::new(), ..tree })
    });
    folded(&shapes.collect::<String>())
}

fn folded(dump: &str) -> String {
    dump.to_uppercase().replace(' ', "")
}

#[test]
fn formatting_bodies() {
    check_format(
        "program p\n// start\nld a (* one *)\nandn( b\nor c // two\n)\n  ST  d;\n\n   (* three *)\nl1: ld 5\nadd x , 3\nst? e\njmpcn   l1\nend_program\n",
        expect![[r#"
            |PROGRAM p
            |    // start
            |    LD      a                           (* one *)
            |    ANDN(   b
            |        OR      c                       // two
            |    )
            |    ST      d
            |
            |(* three *)
            |l1:
            |    LD      5
            |    ADD     x, 3
            |    ST?     e
            |    JMPCN   l1
            |END_PROGRAM
            |
        "#]],
    );
    check_format(
        "CAL T1(IN:=a, // why\nPT:=T#1s,not Q=>b)\ncalc c10( a ,b , 5 )\nLIMIT(MN:=(\nLD 1\n), IN:=limit_of [ 1 ,i ] . x)\ncu c10\nret\nCAL T2()\nAND(LD x\nOR y) (* tail *)\n",
        expect![[r#"
            |    CAL     T1(
            |        IN := a,                        // why
            |        PT := T#1s,
            |        NOT Q => b
            |    )
            |    CALC    c10(a, b, 5)
            |    LIMIT(
            |        MN := (
            |            LD      1
            |        ),
            |        IN := limit_of[1, i].x
            |    )
            |    CU      c10
            |    RET
            |    CAL     T2()
            |    AND(
            |        LD      x
            |        OR      y
            |    )                                   (* tail *)
            |
        "#]],
    );
    check_format(
        "LD a ; one\n  ; two\nST b;ST c;\n(* over\n   lines *)\nLD x b\n   JMP\nNOT\n",
        expect![[r#"
            |    LD      a                           ; one
            |    ; two
            |    ST      b
            |    ST      c
            |(* over
            |   lines *)
            |LD x b
            |   JMP
            |    NOT
            |
        "#]],
    );
    assert_eq!(formatted("LD a\r\nl: ST b\r\n"), "    LD      a\r\nl:\r\n    ST      b\r\n");
}

#[test]
fn formatting_declarations() {
    check_format(
        "var inp: bool; end_var\nvar_input retain a,b:int:=5;(* both *)\n// why\nlong_name at %ix0.0 :bool; t : string [ 20 ] := 'x' ;\n\nm : array[ 0..3 ] of int := [ 1,2 ,\n 2 ( 0 ) ];\nbroken : ;\nend_var\n",
        expect![[r#"
            |VAR
            |    inp : BOOL;
            |END_VAR
            |VAR_INPUT RETAIN
            |    a, b                : INT                := 5; (* both *)
            |    // why
            |    long_name AT %IX0.0 : BOOL;
            |    t                   : STRING[20]         := 'x';
            |
            |    m                   : ARRAY[0..3] OF INT := [1, 2,
            |        2(0)];
            |broken : ;
            |END_VAR
            |
        "#]],
    );
    // A comment before the end of something is the last thing in it.
    check_format(
        "program p\nvar a : bool;\n// no more\nend_var\nld a\nst a\n\n(* and so on *)\n\nend_program\n(* behind *)\n",
        expect![[r#"
            |PROGRAM p
            |VAR
            |    a : BOOL;
            |    // no more
            |END_VAR
            |    LD      a
            |    ST      a
            |
            |    (* and so on *)
            |
            |END_PROGRAM
            |(* behind *)
            |
        "#]],
    );
    check_format(
        "type colour:(Red,Green):=Red; p:struct x,y:int; inner : struct z:bool:=true; end_struct; end_struct;r: int( 0..9 );end_type\n",
        expect![[r#"
            |TYPE
            |    colour : (Red, Green) := Red;
            |    p      : STRUCT
            |        x, y  : INT;
            |        inner : STRUCT
            |            z : BOOL := TRUE;
            |        END_STRUCT;
            |    END_STRUCT;
            |    r : INT(0..9);
            |END_TYPE
            |
        "#]],
    );
    check_format(
        "configuration c var_global g:int; end_var resource r on cpu task t( interval:=t#1s,priority:=1 ); program p with t:main(a:=g,b=>g);end_resource end_configuration\n",
        expect![[r#"
            |CONFIGURATION c
            |    VAR_GLOBAL
            |        g : INT;
            |    END_VAR
            |    RESOURCE r ON cpu
            |        TASK t(INTERVAL := t#1s, PRIORITY := 1);
            |        PROGRAM p WITH t : main(a := g, b => g);
            |    END_RESOURCE
            |END_CONFIGURATION
            |
        "#]],
    );
    check_format(
        "function f:int var_input a:int; end_var ld a st b\nend_function function_block g end_function_block\n",
        expect![[r#"
            |function f:int var_input a:int; end_var ld a st b
            |END_FUNCTION
            |FUNCTION_BLOCK g
            |END_FUNCTION_BLOCK
            |
        "#]],
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn formatting_twice_changes_nothing(text in any_text()) {
        let tree = parse(&text, iec());
        let once = format_chunk(&text, &tree, &FormatOptions::default());
        let again = parse(&once, iec());
        prop_assert_eq!(&format_chunk(&once, &again, &FormatOptions::default()), &once);
        let items = |text: &str, tree: IecTree| folded(&dump(text, &IecTree { problems: Vec::new(), ..tree }));
        prop_assert_eq!(items(&text, tree), items(&once, again));
    }
}

/// Programs by other authors, if they lie beside the repository: only hints, and the formatter takes them.
#[test]
fn programs_by_others() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/corpus/iec");
    let folder = std::env::var_os("RUNGWISE_CORPUS")
        .map_or(folder, |corpus| std::path::Path::new(&corpus).join("iec"));
    let Ok(files) = std::fs::read_dir(&folder) else {
        crate::corpus::say_skipped(&format!("no programs in {} (set RUNGWISE_CORPUS)", folder.display()));
        return;
    };
    let mut read = 0;
    for file in
        files.map(|file| file.unwrap().path()).filter(|file| file.extension().is_some_and(|end| end == "il"))
    {
        let text = std::fs::read_to_string(&file).unwrap();
        for chunk in chunks(&text) {
            let tree = parse(chunk, iec());
            assert_spans_in_range(chunk, &tree);
            let errors = tree.problems.iter().filter(|problem| problem.severity != Severity::Hint).count();
            assert_eq!(errors, 0, "{}\n{}", file.display(), problems(chunk, &tree));
        }
        let whole = parse(&text, iec());
        assert_eq!(
            folded(&dump(&text, &IecTree { problems: Vec::new(), ..whole })),
            shape(&text),
            "chunks make the file"
        );
        let result = formatted(&text);
        assert_eq!(formatted(&result), result);
        assert_eq!(shape(&text), shape(&result));
        assert!(result.contains("\nEND_PROGRAM") && !result.contains(" cal "), "{result}");
        read += 1;
    }
    assert!(read > 0, "no programs in {}", folder.display());
}

#[test]
fn mentions_of_names() {
    let text = "PROGRAM Main\nVAR a, b : MyType := Colour#Red; END_VAR\nTYPE E : (X, Y); S : STRUCT f : INT(0..N); END_STRUCT; END_TYPE\nl1: LD a.b[i].c\nST q[j]\nS m\nCAL T1(\nIN := (\nLD z\n),\nNOT Q => w\n)\nCU C1\nJMPC l1\nFB.M1 p, 5\nLIMIT(\nMN := k\n)\nEND_PROGRAM\n";
    let tree = parse(text, iec());
    let mut out = String::new();
    for mention in tree.mentions(text) {
        writeln!(out, "{} {:?}", mention.span.of(text), mention.role).unwrap();
    }
    expect![[r#"
        Main DeclaresPou(Program)
        a DeclaresVariable
        b DeclaresVariable
        MyType NamesType
        Colour NamesType
        E DeclaresType
        X DeclaresEnumerator
        Y DeclaresEnumerator
        S DeclaresType
        f DeclaresField
        N Reads
        l1 DeclaresLabel
        a Reads
        b NamesMember
        i Reads
        c NamesMember
        q Writes
        j Reads
        m Writes
        T1 Calls
        IN NamesParameter
        z Reads
        Q NamesParameter
        w Writes
        CU NamesMember
        C1 Calls
        l1 Jumps
        FB Calls
        M1 NamesMember
        p Reads
        LIMIT CallsFunction
        MN NamesParameter
        k Reads
    "#]]
    .assert_eq(&out);
    let text = "CONFIGURATION c\nRESOURCE r ON cpu\nTASK t(SINGLE := g.x, PRIORITY := 1);\nPROGRAM p WITH t : Main(in := v, out => w, f WITH t);\nEND_RESOURCE\nVAR_CONFIG r.p.x AT %QX0.1 : BOOL; END_VAR\nEND_CONFIGURATION\n";
    let tree = parse(text, iec());
    let names: Vec<String> =
        tree.mentions(text).map(|mention| format!("{} {:?}", mention.span.of(text), mention.role)).collect();
    expect![[r#"
        c DeclaresRuntime
        r DeclaresRuntime
        cpu NamesRuntime
        t DeclaresRuntime
        g Reads
        x NamesMember
        p DeclaresRuntime
        t NamesRuntime
        Main NamesType
        in NamesParameter
        v Reads
        out NamesParameter
        w Writes
        f NamesParameter
        t NamesRuntime
        r Writes
        p NamesMember
        x NamesMember"#]]
    .assert_eq(&names.join("\n"));
    assert!(same_name("Motor_1", "mOTOR_1") && !same_name("Motor", "Moto"));
    assert_eq!(fold_case("Motor_1"), "MOTOR_1");
}

/// Reading is linear: ten times the text takes about ten times as long, not a hundred.
#[test]
fn reading_is_not_quadratic() {
    let pieces = [
        "LD a\nAND( b\nOR c\n)\nST d\n",
        "CAL T1(\nIN := a,\nPT := b\n)\n",
        "; c\n",
        "AND(\n",
        "VAR a : INT\n",
        ";",
        "(a, ",
        "LD [",
        "x := (\n",
        "/*",
        "TYPE s : STRUCT ",
    ];
    for piece in pieces {
        let time = |count: usize| {
            let text = piece.repeat(count);
            let start = cpu_time::ThreadTime::now();
            let tree = parse(&text, iec());
            let ends = split(&text);
            assert!(!ends.is_empty() && tree.comments.len() <= text.len());
            start.elapsed()
        };
        let (short, long) = (time(2_000), time(20_000));
        assert!(
            long < short * 40 + std::time::Duration::from_millis(200),
            "{piece:?}: {short:?}, then {long:?}"
        );
    }
}

#[test]
fn a_parenthesis_in_the_wrong_place_is_one_problem() {
    let tree = parse("LD (a\nAND a\nST a\n", iec());
    let codes: Vec<&str> = tree.problems.iter().map(|problem| problem.code).collect();
    assert_eq!(codes, ["syntax-error"]);
}
