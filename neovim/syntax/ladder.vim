" Ladder diagrams drawn in characters, for editors without the language server's semantic tokens.
if exists('b:current_syntax')
  finish
endif

syntax case ignore
syntax sync minlines=200
syntax iskeyword @,48-57,_,192-255,#,%,.

syntax match rungwiseWire /[-─━═+*┌┐└┘┬┴|│┃!├┤┼]/
syntax match rungwiseAddress /\v\%[IQM][XBWDL]?\d+(\.\d+)*/
syntax match rungwiseDevice /\v<([XYMSTCDRVZPIN]\d+)([VZ]\d+)?(\.[0-9A-F])?>/
syntax match rungwiseDevice /\v<K[1-8][XYMS]\d+([VZ]\d+)?>/
syntax match rungwiseNumber /\v<(K[-+]?\d+|H[0-9A-F]+)>/
syntax match rungwiseNumber /\v<L?(T|TIME)#[-+]?\d[0-9A-Z_.]*/
syntax match rungwiseContact /\v[-─━═+┬├┼]@1<=\|[ \/PN↑↓]\|[-─━═+┬┤┼]@=/
syntax match rungwiseContact /\v[-─━═+┬├┼]@1<=![ \/]![-─━═+┬┤┼]@=/
syntax match rungwiseContact /\v\][ \/\\PN↑↓]\[/
syntax match rungwiseContact /\v\[[ \/\\PN↑↓]\]/
syntax match rungwiseContact /\v┤[ \/PN↑↓]├/
syntax region rungwiseCoil matchgroup=rungwiseCoil start=/(\*\@!/ end=/)/ oneline contains=rungwiseDevice,rungwiseAddress,rungwiseNumber
syntax region rungwiseBox matchgroup=rungwiseBox start=/\v\[%([^]]{2})@=/ end=/\]/ oneline
      \ contains=rungwiseBoxWord,rungwiseCompare,rungwiseDevice,rungwiseAddress,rungwiseNumber
syntax match rungwiseBoxWord /\v\[@1<=\s*\a\w*>/ contained contains=rungwiseDevice
syntax match rungwiseCompare /\v\<\>|\>\=|\<\=|[=<>]/ contained
syntax match rungwiseJump /\v\>\>\s*\w+|\<\s*RET(URN)?\s*\>|-@1<=\>\h\w*\>|^\s*\>\h\w*\>/
syntax match rungwiseLabel /\v^\s*\w+:\s*$/
syntax match rungwiseKeyword /\v^\s*NETWORK>.*$/
syntax match rungwiseKeyword /\v^\s*(END_)?(PROGRAM|FUNCTION_BLOCK|FUNCTION)>/
syntax region rungwiseDeclarations matchgroup=rungwiseKeyword start=/\v^\s*VAR(_\a+)?>/ end=/\v<END_VAR>/
      \ contains=rungwiseComment,rungwiseAddress,rungwiseNumber
syntax region rungwiseComment start=/(\*/ end=/\*)/ contains=@Spell,rungwiseDirective
syntax match rungwiseComment "//.*$" contains=@Spell,rungwiseDirective
syntax match rungwiseComment /\v^\s*;.*$/ contains=@Spell
syntax match rungwiseDirective /\vrungwise:\s*(allow|never)>/ contained

highlight default link rungwiseWire Delimiter
highlight default link rungwiseContact Operator
highlight default link rungwiseCoil Statement
highlight default link rungwiseBox Delimiter
highlight default link rungwiseBoxWord Statement
highlight default link rungwiseCompare Operator
highlight default link rungwiseDevice Identifier
highlight default link rungwiseAddress Identifier
highlight default link rungwiseNumber Number
highlight default link rungwiseJump Special
highlight default link rungwiseLabel Label
highlight default link rungwiseKeyword Keyword
highlight default link rungwiseComment Comment
highlight default link rungwiseDirective SpecialComment

let b:current_syntax = 'ladder'
