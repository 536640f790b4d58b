--- A timing chart as text: a line for each signal, its changes as bars between the rows of a panel. Pure.
local M = {}

local BITS = { off = '▁', on = '▆', both = '▌' }
local STEPS = { '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█' }
local UNKNOWN = ' '

--- A value as a number.
local function size(value)
  if type(value) == 'boolean' then
    return value and 1 or 0
  end
  return tonumber(value) or 0
end

--- The least, the greatest and the last value in each column of a signal; nil where nothing is known.
--- @param points [integer, any][] changes in the order of scans
--- @param view { from: integer, scans: integer, width: integer, last: integer } `scans` for each of `width` columns
function M.columns(points, view)
  local columns, at, value = {}, 1, nil
  for column = 1, view.width do
    local first = view.from + (column - 1) * view.scans
    local least, greatest
    if first <= view.last then
      while points[at] and points[at][1] <= first do
        value, at = size(points[at][2]), at + 1
      end
      least, greatest = value, value
      while points[at] and points[at][1] < first + view.scans do
        value, at = size(points[at][2]), at + 1
        least, greatest = math.min(least or value, value), math.max(greatest or value, value)
      end
    end
    columns[column] = least and { least = least, greatest = greatest, last = value } or false
  end
  return columns
end

--- The line of a relay.
function M.bit_line(columns)
  return table.concat(vim.tbl_map(function(column)
    if not column then
      return UNKNOWN
    end
    return column.least ~= column.greatest and BITS.both or column.last ~= 0 and BITS.on or BITS.off
  end, columns))
end

--- The line of a number, from the least to the greatest value that is shown.
function M.word_line(columns)
  local least, greatest = math.huge, -math.huge
  for _, column in ipairs(columns) do
    if column then
      least, greatest = math.min(least, column.least), math.max(greatest, column.greatest)
    end
  end
  return table.concat(vim.tbl_map(function(column)
    if not column then
      return UNKNOWN
    end
    local share = greatest > least and (column.last - least) / (greatest - least) or 0
    return STEPS[1 + math.floor(share * (#STEPS - 1) + 0.5)]
  end, columns))
end

return M
