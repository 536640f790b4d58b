--- The answer to Enter in a drawing: it opens a branch or a rung, and what is typed next goes into that.
local client = require('rungwise.client')
local M = {}

local METHOD = 'textDocument/onTypeFormatting'
--- A server that takes longer is not waited for.
local PATIENCE_MS = 1000
--- The name of an element of which a person is to choose one.
local PLACEHOLDER = '???'
--- A row of wire from rail to rail, and its cells before those where the first contact goes.
local EMPTY_RUNG = [[^\s*[+├][-─]\+[+┤]$]]
local FIRST_CELLS = 4

--- The byte at which the first contact of an empty rung goes.
local function first_place(line)
  local indent = #line:match('^%s*')
  return indent + math.max(0, vim.fn.byteidx(line:sub(indent + 1), FIRST_CELLS))
end

--- The place to type on that came with edits, once they are made: row from 0, first byte, the one behind; a name to choose
--- goes before a new rung. Enter was pressed in the row above `row`, behind byte `column`: the new branch is below that,
--- and of several names that are still to be chosen it has the one nearest to the column.
local function place_of(edits, buffer, row, column)
  edits = vim.deepcopy(edits)
  table.sort(edits, function(a, b)
    local left, right = a.range.start, b.range.start
    return left.line < right.line or (left.line == right.line and left.character < right.character)
  end)
  local added, name, rung = 0, nil, nil
  for _, edit in ipairs(edits) do
    local lines = vim.split(edit.newText, '\n', { plain = true })
    for index, written in ipairs(lines) do
      local at = edit.range.start.line + added + index - 1
      local line = vim.api.nvim_buf_get_lines(buffer, at, at + 1, false)[1] or ''
      -- The first line of an edit may be a part of a row only.
      local from = at >= row and written:find(PLACEHOLDER, 1, true) and line:find(PLACEHOLDER, 1, true)
      while from do
        local far = math.abs(from - 1 - column)
        if not name or far < name.far then
          name = { far = far, row = at, from = from - 1 }
        end
        from = line:find(PLACEHOLDER, from + 1, true)
      end
      if line == written and vim.fn.match(line, EMPTY_RUNG) >= 0 then
        rung = rung or { at, first_place(line) }
      end
    end
    added = added + #lines - 1 - (edit.range['end'].line - edit.range.start.line)
  end
  if name then
    return name.row, name.from, name.from + #PLACEHOLDER
  elseif rung then
    return rung[1], rung[2], rung[2]
  end
end

--- Keys that select from a byte of a row to before another one, for typing over it; in Insert mode and out of it.
local function select(row, from, to)
  local cursor = '<Cmd>call cursor(%d, %d)<CR>'
  return ('<Esc>' .. cursor .. 'v' .. cursor .. '<C-g>'):format(row + 1, from + 1, row + 1, to)
end

--- Puts the cursor where one types on after edits, and has `typed` typed there. `place` is the row of the line that Enter
--- made and the byte at which it cut the one above.
local function type_on(edits, buffer, place, typed)
  local row, from, to = place_of(edits, buffer, unpack(place))
  local inserts = vim.fn.mode():match('^[iR]') ~= nil
  local before, after = '', ''
  if row and from < to then
    -- In a hurry Insert mode was left before the answer came; without anything to type over it stays so.
    before = (inserts or typed ~= '') and select(row, from, to) or ''
  elseif row then
    vim.api.nvim_win_set_cursor(0, { row + 1, from })
  end
  if not inserts and typed ~= '' then
    before = before == '' and 'i' or before
    after = '<Esc>'
  end
  -- What came by keys goes in by keys, before those that wait, so that it is answered like all that is typed; but not as
  -- if it were typed, for a macro that is being recorded has it already, and holds no places of this text.
  vim.api.nvim_feedkeys(vim.keycode(before) .. typed .. vim.keycode(after), 'ni', true)
end

--- Has the server answer Enter, which ended at `place`, { row, byte } from 0. `typed` was typed behind it before it could be
--- answered: that is taken out and typed again where the answer has a place for it. `quietly` runs changes that are the
--- plugin's own. Answers whether there was something to do.
function M.answer(running, buffer, place, typed, quietly)
  local row, byte = unpack(place)
  typed = typed or ''
  local text = vim.api.nvim_buf_get_lines(buffer, row, row + 1, false)[1] or ''
  if text:sub(byte - #typed + 1, byte) ~= typed then
    return false
  end
  local start = byte - #typed
  local function put(old, new)
    if old ~= new then
      quietly(buffer, function()
        vim.api.nvim_buf_set_text(buffer, row, start, row, start + #old, { new })
      end)
    end
  end
  put(typed, '')
  local column = #(vim.api.nvim_buf_get_lines(buffer, row - 1, row, false)[1] or '')
  local tick = vim.api.nvim_buf_get_changedtick(buffer)
  local encoding = running.offset_encoding
  local params = vim.lsp.util.make_formatting_params()
  params.textDocument = { uri = vim.uri_from_bufnr(buffer) }
  params.position = { line = row, character = client.character(text, start, encoding) }
  params.ch = '\n'
  local edits = client.request_sync(running, METHOD, params, PATIENCE_MS, buffer)
  if vim.api.nvim_buf_get_changedtick(buffer) ~= tick then
    -- While it was waited for, something else has changed the text for which the answer was made.
    vim.api.nvim_feedkeys(typed, 'ni', true)
    return true
  elseif type(edits) ~= 'table' or #edits == 0 then
    put('', typed)
    return false
  end
  quietly(buffer, function()
    if not vim.fn.mode():match('^[iR]') then
      vim.cmd('silent! undojoin')
    end
    vim.lsp.util.apply_text_edits(edits, buffer, encoding)
  end)
  type_on(edits, buffer, { row, column }, typed)
  return true
end

return M
