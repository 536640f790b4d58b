--- What users call from their configuration.
local M = {}

--- Text for the status line: target, dialect and program steps of the buffer, and the mode of the PLC that is connected,
--- with `≠` where another program is in it; blank when nothing is known.
function M.statusline()
  local status = require('rungwise.client').status[vim.uri_from_bufnr(0)]
  if not status then
    return ''
  end
  local parts = { tostring(status.target):upper() }
  if type(status.dialect) == 'string' and status.dialect ~= status.target and status.dialect ~= 'ladder' then
    table.insert(parts, status.dialect:upper())
  end
  if type(status.steps) == 'number' then
    local capacity = type(status.capacity) == 'number' and '/' .. status.capacity or ''
    table.insert(parts, require('rungwise.words').t('%d%s steps', status.steps, capacity))
  end
  if type(status.mode) == 'string' then
    local is_other = require('rungwise.drift').matches[status.uri] == 'different'
    table.insert(parts, 'PLC ' .. status.mode .. (is_other and ' ≠' or ''))
  end
  return table.concat(parts, ' · ')
end

return M
