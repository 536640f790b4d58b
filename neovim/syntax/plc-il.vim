" Instruction List, for editors without the language server's semantic tokens.
if exists('b:current_syntax')
  finish
endif

syntax case ignore
syntax sync minlines=200
" An address (%IX0.0), a typed literal (INT#5) and an element (Delay.R) are one word each, so no part of them is a keyword.
syntax iskeyword @,48-57,_,192-255,#,%,.
runtime! syntax/rungwise_keywords.vim

syntax match rungwiseMnemonic /\v<(LD|AND|OR)D?(\<\>|\>\=|\<\=|[=<>])/
syntax match rungwiseOperator /&N\?/
syntax match rungwiseDevice /\v<([XYMSTCDRVZPIN]\d+)([VZ]\d+)?(\.[0-9A-F])?>/
syntax match rungwiseAddress /\v\%[IQM][XBWDL]?(\*|\d+(\.\d+)*)/
syntax match rungwiseNumber /\v<[-+]?\d[0-9_]*(\.\d[0-9_]*(E[-+]?\d+)?)?>/
syntax match rungwiseNumber /\v<(2#[01_]+|8#[0-7_]+|16#[0-9A-F_]+)>/
syntax match rungwiseNumber /\v<(K[-+]?\d+|H[0-9A-F]+|E\d+(\.\d+)?)>/
syntax match rungwiseDevice /\v<K[1-8][XYMS]\d+([VZ]\d+)?>/
syntax match rungwiseNumber /\v<\h\w*#[-+]?[0-9A-Z_.:-]+/
syntax match rungwiseParameter /\v<\h\w*\ze\s*(:\=|\=\>)/
syntax match rungwiseLabel /\v^\s*\h\w*\ze\s*:([^=]|$)/
syntax match rungwiseLabel /\v^\s*(\d+\s+)?\zs[PI]\d+\ze\s*$/
syntax match rungwiseStep /\v^\s*\zs\d+\ze\s+\a/
syntax region rungwiseString start=/'/ skip=/\$'/ end=/'/ oneline
syntax region rungwiseString start=/"/ skip=/\$"/ end=/"/ oneline
syntax region rungwisePragma start=/{/ end=/}/
syntax region rungwiseDeclarations matchgroup=rungwiseKeyword start=/\v<VAR(_\a+)?>/ end=/\v<END_VAR>/
      \ contains=rungwiseComment,rungwiseKeyword,rungwiseType,rungwiseBlock,rungwiseNumber,rungwiseString,rungwiseAddress,rungwisePragma
syntax region rungwiseComment start=/(\*/ end=/\*)/ contains=@Spell,rungwiseDirective
syntax match rungwiseComment /;.*$/ contains=@Spell
syntax match rungwiseComment "//.*$" contains=@Spell,rungwiseDirective containedin=rungwiseDeclarations
syntax match rungwiseDirective /\vrungwise:\s*(allow|never)>/ contained

highlight default link rungwiseMnemonic Statement
highlight default link rungwiseOperator Statement
highlight default link rungwiseFunction Function
highlight default link rungwiseBlock Structure
highlight default link rungwiseKeyword Keyword
highlight default link rungwiseType Type
highlight default link rungwiseDevice Identifier
highlight default link rungwiseAddress Identifier
highlight default link rungwiseParameter Identifier
highlight default link rungwiseNumber Number
highlight default link rungwiseLabel Label
highlight default link rungwiseStep LineNr
highlight default link rungwiseString String
highlight default link rungwisePragma PreProc
highlight default link rungwiseComment Comment
highlight default link rungwiseDirective SpecialComment

let b:current_syntax = 'plc-il'
