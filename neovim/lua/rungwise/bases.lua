--- How the numbers of registers are written and typed: decimal, hexadecimal, binary, and of two registers 32 bits or a
--- floating point number.
local ffi = require('ffi')
local M = {}

M.names = { 'decimal', 'hexadecimal', 'binary', 'double', 'float' }

local cell = ffi.new('union { int32_t whole; float real; }')

--- The bases in which a row of a panel can be shown.
function M.of(row)
  if row.type == 'bit' or row.unit_ms then
    return { 'decimal' }
  end
  return row.name:find('^D%d+$') and M.names or vim.list_slice(M.names, 1, 3)
end

--- What is read for a row in a base.
function M.read_as(name, base)
  return (base == 'double' or base == 'float') and name .. ':32' or name
end

--- A number as it is written in a base.
function M.written(value, base)
  if type(value) ~= 'number' or value ~= math.floor(value) then
    return tostring(value)
  end
  local bits = value >= -0x8000 and value <= 0x7fff and 16 or 32
  local pattern = value < 0 and value + 2 ^ bits or value
  if base == 'hexadecimal' then
    return 'H' .. ('%0' .. bits / 4 .. 'X'):format(pattern)
  elseif base == 'binary' then
    local digits = {}
    for bit = bits - 1, 0, -1 do
      table.insert(digits, math.floor(pattern / 2 ^ bit) % 2 == 1 and '1' or '0')
      if bit > 0 and bit % 4 == 0 then
        table.insert(digits, ' ')
      end
    end
    return table.concat(digits)
  elseif base == 'float' then
    cell.whole = value
    return ('%.7g'):format(cell.real)
  end
  return ('%d'):format(value)
end

--- What is written for a word that was typed in a base; nil for one that is no number there. Other words are read by the
--- server.
function M.typed(word, base)
  if base == 'float' then
    cell.real = tonumber(word) or 0
    return tonumber(word) and cell.whole or nil
  elseif base == 'binary' and word:find('^[01 ]+$') then
    local value = tonumber((word:gsub(' ', '')), 2)
    return value and value >= 0x8000 and value < 0x10000 and value - 0x10000 or value
  elseif base == 'hexadecimal' then
    return 'H' .. word:gsub('^[Hh]', '')
  end
  return word
end

return M
