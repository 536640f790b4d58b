--- Text objects of a drawing: element, rung, branch and network. The server says where they are.
local client = require('rungwise.client')
local M = {}

local TIMEOUT_MS = 1000

--- Each by the letter behind `i` or `a`.
M.objects = { e = 'element', r = 'rung', b = 'branch', n = 'network' }

--- A position of the protocol as the cursor takes it: line from 1, column in bytes from 0.
local function cursor(position, encoding)
  local text = vim.api.nvim_buf_get_lines(0, position.line, position.line + 1, false)[1] or ''
  return { position.line + 1, client.byte(text, position.character, encoding) }, #text
end

--- Selects an object around the cursor, for Visual and Operator-pending mode. The cursor stays when there is none.
function M.select(object, around)
  local buffer = vim.api.nvim_get_current_buf()
  local running = client.clients(buffer)[1]
  if not running then
    return
  end
  local encoding = running.offset_encoding
  local params = vim.lsp.util.make_position_params(0, encoding)
  params.object, params.around = object, around
  local result = client.request_sync(running, 'rungwise/object', params, TIMEOUT_MS, buffer)
  if type(result) ~= 'table' or type(result.range) ~= 'table' then
    return
  end
  if vim.fn.mode():match('[vV\22]') then
    vim.cmd.normal({ vim.keycode('<Esc>'), bang = true })
  end
  local from = cursor(result.range.start, encoding)
  local to, length = cursor(result.range['end'], encoding)
  local mode = result.blockwise and '\22' or 'v'
  if not result.blockwise and from[2] == 0 and (to[2] == 0 or to[2] >= length) then
    mode = 'V'
  end
  -- The range ends behind the last character, Visual mode on it.
  if to[2] > 0 then
    to[2] = to[2] - 1
  elseif to[1] > from[1] then
    to = { to[1] - 1, math.max(0, vim.fn.col({ to[1] - 1, '$' }) - 2) }
  end
  vim.api.nvim_win_set_cursor(0, from)
  vim.cmd.normal({ mode, bang = true })
  vim.api.nvim_win_set_cursor(0, { to[1], math.min(to[2], math.max(0, vim.fn.col({ to[1], '$' }) - 2)) })
end

return M
