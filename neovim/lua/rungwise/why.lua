--- Why a device is on or off: the reasons of the simulator in a floating window.
local t = require('rungwise.words').t
local M = {}

--- The reasons one below the other, set in by how deep they stand: lines, and the reason of each.
function M.lines(reason, depth, lines, reasons)
  depth, lines, reasons = depth or 0, lines or {}, reasons or {}
  local place = type(reason.range) == 'table' and t('  [line %d]', reason.range.start.line + 1) or ''
  table.insert(lines, ('  '):rep(depth) .. reason.text .. place)
  table.insert(reasons, reason)
  for _, behind in ipairs(reason.because or {}) do
    M.lines(behind, depth + 1, lines, reasons)
  end
  return lines, reasons
end

--- Shows an answer of `rungwise.simulate.why`; Enter in the window goes to the instruction of a line.
function M.show(reason, encoding)
  local lines, reasons = M.lines(reason)
  local buffer, window = vim.lsp.util.open_floating_preview(lines, 'text', {
    border = 'rounded', focus_id = 'rungwise_why', wrap = false,
  })
  vim.keymap.set('n', '<CR>', function()
    local chosen = reasons[vim.api.nvim_win_get_cursor(window)[1]]
    if chosen and type(chosen.range) == 'table' then
      vim.api.nvim_win_close(window, true)
      vim.lsp.util.show_document({ uri = chosen.uri, range = chosen.range }, encoding, { focus = true })
    end
  end, { buffer = buffer, desc = t('Go to the instruction') })
end

return M
