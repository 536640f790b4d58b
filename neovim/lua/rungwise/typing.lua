--- What happens while one types: on-type formatting, and mending after deletions and pastes.
---
--- Neovim 0.11 has no on-type formatting of its own, so it is asked for here; later ones have it, and theirs is used.
local client = require('rungwise.client')
local M = {}

local TRIGGERS = 'textDocument/onTypeFormatting'
--- A change of more lines is another program, not an edit of a drawing.
local MOST_LINES = 400

--- State of each buffer: { lines, seq, typed, first, last, quiet }.
local states = {}

--- Runs changes that are the plugin's own, which call for no mending.
function M.quietly(buffer, change)
  local state = states[buffer]
  if state then
    state.quiet = true
  end
  local ok, reason = pcall(change)
  if state then
    state.quiet = false
    state.first, state.last = nil, nil
    state.seq = vim.api.nvim_buf_call(buffer, vim.fn.undotree).seq_last
  end
  if not ok then
    error(reason, 0)
  end
end

--- Applies edits, as a part of the undo step of the change before them, unless the text has changed meanwhile.
local function apply(buffer, tick, edits, encoding)
  if not vim.api.nvim_buf_is_valid(buffer) or vim.api.nvim_buf_get_changedtick(buffer) ~= tick then
    return
  elseif type(edits) ~= 'table' or #edits == 0 then
    return
  end
  M.quietly(buffer, function()
    vim.api.nvim_buf_call(buffer, function()
      -- In Insert mode everything is one step as it is; after undo there is nothing to join.
      if not vim.fn.mode():match('^[iR]') then
        vim.cmd('silent! undojoin')
      end
      vim.lsp.util.apply_text_edits(edits, buffer, encoding)
    end)
  end)
end

--- Asks for on-type formatting of the character that was just typed.
local function format_typed(running, buffer, character)
  local params = vim.lsp.util.make_formatting_params()
  params.position = vim.lsp.util.make_position_params(0, running.offset_encoding).position
  params.ch = character
  local tick = vim.api.nvim_buf_get_changedtick(buffer)
  client.request(running, TRIGGERS, params, function(err, edits)
    if not err then
      apply(buffer, tick, edits, running.offset_encoding)
    end
  end, buffer)
end

--- Asks for the mending of lines, first and last from 0.
local function mend(running, buffer, first, last)
  local text = vim.api.nvim_buf_get_lines(buffer, last, last + 1, false)[1] or ''
  local params = {
    textDocument = { uri = vim.uri_from_bufnr(buffer), version = vim.lsp.util.buf_versions[buffer] },
    range = {
      start = { line = first, character = 0 },
      ['end'] = { line = last, character = client.character(text, #text, running.offset_encoding) },
    },
    edit = 'mend',
  }
  local tick = vim.api.nvim_buf_get_changedtick(buffer)
  client.request(running, 'rungwise/edit', params, function(err, result)
    -- A drawing that cannot be mended stays as it is; its diagnostics say what is wrong.
    if not err and type(result) == 'table' then
      apply(buffer, tick, result.edits, running.offset_encoding)
    end
  end, buffer)
end

--- Whether the server wants to hear of a typed character.
local function triggers(running, character)
  local offered = running.server_capabilities.documentOnTypeFormattingProvider
  if type(offered) ~= 'table' then
    return false
  end
  return offered.firstTriggerCharacter == character
    or vim.list_contains(offered.moreTriggerCharacter or {}, character)
end

--- Something changed in Insert mode: one typed character is formatted, everything else is mended.
local function changed_in_insert(running, buffer, state)
  local typed, first, last = state.typed, state.first, state.last
  state.typed, state.first, state.last = nil, nil, nil
  local lines = vim.api.nvim_buf_line_count(buffer)
  local added = lines - state.lines
  state.lines = lines
  -- Typing over cells moves none of them.
  if not first or vim.fn.mode() == 'R' then
    return
  end
  local character = typed or (added == 1 and last == first + 1 and '\n' or nil)
  if character and vim.fn.strchars(character) == 1 then
    if triggers(running, character) and not M.builtin() then
      format_typed(running, buffer, character)
    end
  elseif added <= 0 or last - first <= MOST_LINES then
    mend(running, buffer, first, last)
  end
end

--- Something changed in Normal mode: a deletion inside lines or a paste is mended, undo and redo are not.
local function changed_in_normal(running, buffer, state)
  local first, last = state.first, state.last
  state.typed, state.first, state.last = nil, nil, nil
  state.lines = vim.api.nvim_buf_line_count(buffer)
  local seq = vim.fn.undotree().seq_last
  local is_new = seq > state.seq
  state.seq = seq
  if is_new and first and last - first <= MOST_LINES then
    mend(running, buffer, first, last)
  end
end

--- Notes which lines a change has touched. Whole lines that go away, and cells that are replaced, move nothing sideways.
local function note(state, start_row, start_col, old_row, old_col, new_row, new_col)
  local removes_lines = start_col == 0 and old_col == 0 and new_col == 0 and old_row > 0 and new_row == 0
  local same_width = old_row == 0 and new_row == 0 and old_col == new_col
  if state.quiet or removes_lines or same_width then
    return
  end
  state.first = math.min(state.first or start_row, start_row)
  state.last = math.max(state.last or 0, start_row + new_row)
end

--- Whether this Neovim formats on typing by itself.
function M.builtin()
  return vim.lsp.on_type_formatting ~= nil
end

--- Starts looking after a buffer; called when the server attaches to a ladder.
function M.attach(buffer)
  if states[buffer] or client.options().on_type == false then
    return
  end
  local state = {
    lines = vim.api.nvim_buf_line_count(buffer),
    seq = vim.api.nvim_buf_call(buffer, vim.fn.undotree).seq_last,
  }
  states[buffer] = state
  if M.builtin() then
    vim.lsp.on_type_formatting.enable(true)
  end
  vim.api.nvim_buf_attach(buffer, false, {
    on_bytes = function(_, _, _, row, column, _, old_row, old_col, _, new_row, new_col)
      note(state, row, column, old_row, old_col, new_row, new_col)
    end,
    on_reload = function()
      state.first, state.last, state.lines = nil, nil, vim.api.nvim_buf_line_count(buffer)
    end,
    on_detach = function()
      states[buffer] = nil
    end,
  })
  M.autocommands(buffer, state)
end

--- The events after which a buffer is looked at.
function M.autocommands(buffer, state)
  local group = vim.api.nvim_create_augroup('rungwise_typing_' .. buffer, { clear = true })
  local function on(events, act)
    vim.api.nvim_create_autocmd(events, {
      group = group,
      buffer = buffer,
      callback = function()
        local running = client.clients(buffer)[1]
        if states[buffer] ~= state then
          return true
        elseif running then
          act(running, buffer, state)
        end
      end,
    })
  end
  on('InsertCharPre', function()
    state.typed = (state.typed or '') .. vim.v.char
  end)
  on({ 'TextChangedI', 'TextChangedP' }, changed_in_insert)
  on('TextChanged', changed_in_normal)
  -- The changes of Insert mode were looked at one by one; TextChanged does not see them again.
  on('InsertLeave', function()
    state.seq = vim.fn.undotree().seq_last
    state.typed, state.first, state.last = nil, nil, nil
  end)
end

return M
