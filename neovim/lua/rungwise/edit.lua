--- The structural edits of a drawing: insert a contact, wrap in a branch, delete an element and close the gap …
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

--- Every edit by its name for |:Rungwise-edit|: { name of the server, default key after <localleader>, what it does }.
M.edits = {
  ['insert-contact'] = { 'insertContact', 'c', 'insert a contact' },
  ['insert-negated-contact'] = { 'insertNegatedContact', 'n', 'insert a negated contact' },
  ['insert-coil'] = { 'insertCoil', 'o', 'insert a coil (output)' },
  ['insert-set-coil'] = { 'insertSetCoil', 's', 'insert a set coil' },
  ['insert-reset-coil'] = { 'insertResetCoil', 'r', 'insert a reset coil' },
  ['insert-box'] = { 'insertBox', 'x', 'insert an instruction box' },
  ['insert-branch'] = { 'insertBranch', 'b', 'insert a branch: a contact in parallel' },
  ['insert-rung'] = { 'insertRung', 'g', 'insert a rung below' },
  ['insert-rung-above'] = { 'insertRungAbove', 'G', 'insert a rung above' },
  ['move-branch-up'] = { 'moveBranchUp', 'k', 'move the branch up' },
  ['move-branch-down'] = { 'moveBranchDown', 'j', 'move the branch down' },
  ['wrap-in-branch'] = { 'wrapInBranch', 'p', 'put a branch in parallel to the selection' },
  ['delete-element'] = { 'deleteElement', 'd', 'delete the element and close the gap' },
  ['delete-branch'] = { 'deleteBranch', 'D', 'delete the branch' },
  ['negate'] = { 'negate', 'i', 'negate (invert) the contact or coil' },
  ['mend'] = { 'mend', 'm', 'mend the drawing here' },
}

--- Names of all edits in alphabetical order.
function M.names()
  local names = vim.tbl_keys(M.edits)
  table.sort(names)
  return names
end

--- The Visual selection as a range of the protocol, else the cursor; it leaves Visual mode.
local function selected(encoding)
  local mode = vim.fn.mode()
  if not mode:match('[vV\22]') then
    return vim.lsp.util.make_range_params(0, encoding).range
  end
  vim.api.nvim_feedkeys(vim.keycode('<Esc>'), 'nx', false)
  local first, last = vim.api.nvim_buf_get_mark(0, '<'), vim.api.nvim_buf_get_mark(0, '>')
  -- The range of the protocol ends behind the last character, and a linewise mark is far beyond the line.
  local text = vim.api.nvim_buf_get_lines(0, last[1] - 1, last[1], true)[1]
  local behind = mode == 'V' and #text or math.min(#text, last[2] + 1)
  local function position(line, column)
    local content = vim.api.nvim_buf_get_lines(0, line - 1, line, true)[1]
    return { line = line - 1, character = client.character(content, math.min(column, #content), encoding) }
  end
  return { start = position(first[1], mode == 'V' and 0 or first[2]), ['end'] = position(last[1], behind) }
end

--- Puts the cursor where the server wants it. A name that stands for one to be typed is selected, as in a snippet:
--- in Select mode the first character that is typed replaces it.
local function place_cursor(selection, encoding)
  local function cursor(position)
    local text = vim.api.nvim_buf_get_lines(0, position.line, position.line + 1, false)[1] or ''
    return { position.line + 1, client.byte(text, position.character, encoding) }
  end
  local from, to = cursor(selection.start), cursor(selection['end'])
  vim.api.nvim_win_set_cursor(0, from)
  if vim.deep_equal(from, to) or vim.fn.mode():match('[iR]') then
    return
  end
  vim.cmd.normal({ 'v', bang = true })
  vim.api.nvim_win_set_cursor(0, { to[1], math.max(0, to[2] - 1) })
  vim.api.nvim_feedkeys(vim.keycode('<C-g>'), 'n', false)
end

--- Runs one edit, by its name in |rungwise-edits|, at the cursor or on the Visual selection. `operand` names the device
--- of what is inserted; without it there is a name to type over. It is one undo step.
function M.run(name, operand)
  local edit = M.edits[name]
  local buffer = vim.api.nvim_get_current_buf()
  if not edit then
    client.notify(t('there is no edit "%s"', name), vim.log.levels.ERROR)
    return
  end
  local running = client.expect(buffer)
  if not running then
    return
  end
  local encoding = running.offset_encoding
  local params = {
    textDocument = { uri = vim.uri_from_bufnr(buffer), version = vim.lsp.util.buf_versions[buffer] },
    range = selected(encoding),
    edit = edit[1],
    operand = operand,
  }
  local tick = vim.api.nvim_buf_get_changedtick(buffer)
  client.request(running, 'rungwise/edit', params, function(err, result)
    if err then
      client.notify(err.message or vim.inspect(err), vim.log.levels.WARN)
      return
    elseif not result or vim.api.nvim_buf_get_changedtick(buffer) ~= tick then
      client.notify(t('the drawing changed meanwhile; nothing was done'))
      return
    end
    require('rungwise.typing').quietly(buffer, function()
      vim.lsp.util.apply_text_edits(result.edits, buffer, encoding)
    end)
    if type(result.selection) == 'table' and vim.api.nvim_get_current_buf() == buffer then
      place_cursor(result.selection, encoding)
    end
  end, buffer)
end

return M
