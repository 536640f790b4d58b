--- What happens while one types: on-type formatting, and mending after deletions and pastes.
---
--- Neovim 0.11 has no on-type formatting of its own. Later ones have it, but it drops the answer to a key when the next
--- one comes first, so in drawings it is asked for here.
local client = require('rungwise.client')
local answered = require('rungwise.typed').answered
local enter = require('rungwise.enter')
local M = {}

--- A change of more lines is another program, not an edit of a drawing.
local MOST_LINES = 400

--- State of each buffer: { lines, seq, typed, first, last, place, missing, removed, quiet }.
local states = {}

--- Forgets what has been noted about changes.
local function forget(state)
  state.typed, state.first, state.last, state.removed, state.place, state.missing = nil, nil, nil, nil, nil, nil
end

--- Runs changes that are the plugin's own, which call for no mending.
function M.quietly(buffer, change)
  local state = states[buffer]
  if state then
    state.quiet = true
  end
  local ok, reason = pcall(change)
  if state then
    state.quiet = false
    forget(state)
    state.lines = vim.api.nvim_buf_line_count(buffer)
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

--- Makes a line another one. Only what differs is replaced, for marks in the rest, as of a snippet, have to stay.
local function rewrite(buffer, row, old, new)
  local least = math.min(#old, #new)
  local head, tail = 0, 0
  while head < least and old:byte(head + 1) == new:byte(head + 1) do
    head = head + 1
  end
  while tail < least - head and old:byte(#old - tail) == new:byte(#new - tail) do
    tail = tail + 1
  end
  if old ~= new then
    vim.api.nvim_buf_set_text(buffer, row, head, row, #old - tail, { new:sub(head + 1, #new - tail) })
  end
end

--- Has the server answer characters that end at `place`. Answers whether it could; a row that is as it should be is left.
local function format_typed(running, buffer, characters, place)
  local tick = vim.api.nvim_buf_get_changedtick(buffer)
  local first, before, lines = answered(running, buffer, characters, place[1], place[2])
  -- While it was waited for, something else may have changed the text for which the answer was made.
  if not first or vim.api.nvim_buf_get_changedtick(buffer) ~= tick then
    return false
  end
  local cursor = vim.api.nvim_win_get_cursor(0)
  M.quietly(buffer, function()
    if not vim.fn.mode():match('^[iR]') then
      vim.cmd('silent! undojoin')
    end
    for index, text in ipairs(lines) do
      rewrite(buffer, first + index - 1, before[index], text)
    end
    vim.api.nvim_win_set_cursor(0, cursor)
  end)
  return true
end

--- One place { line, column in bytes } in each block of lines without a blank one: a rung is mended as a whole, and a
--- paste may bring several. `place` is where the last change ended; without it the first line of the drawing is taken,
--- which may have a comment above it.
local function rung_places(buffer, first, last, place)
  local found, chosen, drawn = {}, nil, false
  local lines = vim.api.nvim_buf_get_lines(buffer, first, last + 1, false)
  for index, text in ipairs(vim.list_extend(lines, { '' })) do
    local line = first + index - 1
    if text:match('^%s*$') then
      table.insert(found, chosen)
      chosen, drawn = nil, false
    elseif place and place[1] == line then
      chosen, drawn = place, true
    elseif not drawn then
      drawn = text:match('^%s*[|+]') ~= nil or text:match('^%s*\226\148') ~= nil
      chosen = (drawn or not chosen) and { line, 0 } or chosen
    end
  end
  return found
end

--- Asks for the mending of lines, first and last from 0; cells that are missing are put at `place` if it is known.
local function mend(running, buffer, first, last, place)
  local tick = vim.api.nvim_buf_get_changedtick(buffer)
  local wanted = rung_places(buffer, first, last, place)
  local edits, left = {}, #wanted
  for _, at in ipairs(wanted) do
    local text = vim.api.nvim_buf_get_lines(buffer, at[1], at[1] + 1, false)[1]
    local column = client.character(text, math.min(at[2], #text), running.offset_encoding)
    local position = { line = at[1], character = column }
    local params = {
      textDocument = { uri = vim.uri_from_bufnr(buffer), version = vim.lsp.util.buf_versions[buffer] },
      range = { start = position, ['end'] = position },
      edit = 'mend',
    }
    client.request(running, 'rungwise/edit', params, function(err, result)
      -- A drawing that cannot be mended stays as it is; its diagnostics say what is wrong.
      if not err and type(result) == 'table' then
        vim.list_extend(edits, result.edits)
      end
      left = left - 1
      if left == 0 then
        apply(buffer, tick, edits, running.offset_encoding)
      end
    end, buffer)
  end
end

--- Fills a row up where cells of it went away: wire in a wire, else blanks. Answers whether it could, which is in a
--- drawing only. It is a part of the undo step of the change before it.
local function fill(buffer, place, missing)
  local row, column = place[1], place[2]
  local text = vim.api.nvim_buf_get_lines(buffer, row, row + 1, false)[1] or ''
  if not text:match('^%s*[|+].*[|+]%s*$') then
    return false
  end
  local in_wire = text:sub(column, column + 1):find('-', 1, true)
  local cursor = vim.api.nvim_win_get_cursor(0)
  M.quietly(buffer, function()
    if not vim.fn.mode():match('^[iR]') then
      vim.cmd('silent! undojoin')
    end
    vim.api.nvim_buf_set_text(buffer, row, column, row, column, { (in_wire and '-' or ' '):rep(missing) })
    vim.api.nvim_win_set_cursor(0, cursor)
  end)
  return true
end

--- The last characters of a text whose cells are more than those that went away for them.
local function squeezed_in(typed, wider)
  local characters = vim.fn.split(typed, '\\zs')
  local from = #characters + 1
  while from > 1 and wider > 0 do
    from = from - 1
    wider = wider - #characters[from]
  end
  return vim.list_slice(characters, from)
end

--- Something changed in Insert mode: characters that were typed are formatted, everything else is mended.
local function changed_in_insert(running, buffer, state)
  -- Of characters that are not ASCII the bytes do not tell the cells, so what they replace is mended.
  local is_plain = not (state.removed and state.typed and state.typed:match('[\128-\255]'))
  local typed, first, last = is_plain and state.typed or nil, state.first, state.last
  local place, missing = state.place, state.missing or 0
  forget(state)
  local lines = vim.api.nvim_buf_line_count(buffer)
  local added = lines - state.lines
  state.lines = lines
  -- Typing over cells moves none of them.
  if not first or vim.fn.mode() == 'R' then
    return
  end
  local in_line = added == 0 and first == last
  if in_line and missing > 0 and fill(buffer, place, missing) then
    return
  elseif in_line and typed and missing <= 0 then
    -- What was typed over a selection takes its cells first.
    if format_typed(running, buffer, squeezed_in(typed, -missing), place) then
      return
    end
  elseif added == 1 and last == first + 1 then
    -- A line end that came otherwise, as by a paste, is answered as well.
    if enter.answer(running, buffer, place, typed, M.quietly) or not typed then
      return
    end
  end
  if added <= 0 or last - first <= MOST_LINES then
    mend(running, buffer, first, last, place)
  end
end

--- Something changed in Normal mode: a deletion inside lines or a paste is mended, undo and redo are not.
local function changed_in_normal(running, buffer, state)
  local first, last = state.first, state.last
  local place, missing = state.place, state.missing or 0
  local before = state.lines
  forget(state)
  state.lines = vim.api.nvim_buf_line_count(buffer)
  local seq = vim.fn.undotree().seq_last
  local is_new = seq > state.seq
  state.seq = seq
  if not is_new or not first or last - first > MOST_LINES then
    return
  elseif first ~= last or before ~= state.lines or missing <= 0 or not fill(buffer, place, missing) then
    mend(running, buffer, first, last, place)
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
  state.place = { start_row + new_row, (new_row == 0 and start_col or 0) + new_col }
  state.missing = (state.missing or 0) + old_col - new_col
  state.removed = state.removed or old_row > 0 or old_col > 0
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
  if vim.lsp.on_type_formatting then
    for _, running in ipairs(client.clients(buffer)) do
      vim.lsp.on_type_formatting.enable(false, { client_id = running.id })
    end
  end
  vim.api.nvim_buf_attach(buffer, false, {
    on_bytes = function(_, _, _, row, column, _, old_row, old_col, _, new_row, new_col)
      note(state, row, column, old_row, old_col, new_row, new_col)
    end,
    on_reload = function()
      forget(state)
      state.lines = vim.api.nvim_buf_line_count(buffer)
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
  -- The changes of Insert mode were looked at one by one, but for those of a person who left it in a hurry; TextChanged
  -- does not see them again.
  on('InsertLeave', function(running)
    changed_in_insert(running, buffer, state)
    state.seq = vim.fn.undotree().seq_last
  end)
end

return M
