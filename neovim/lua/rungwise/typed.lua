--- Answers to typed characters, one after another, however fast they come.
---
--- Neovim looks at a text only when it waits for a key, and then several characters may be in it. The server answers the
--- first in the text without the others, and so on: `rungwise/typed` takes lines that the buffer does not have. It is
--- waited for, so that the next key finds a drawing that is whole; it answers within a millisecond.
local client = require('rungwise.client')
local M = {}

--- A server that takes longer is not waited for: the next keys are mended instead.
local PATIENCE_MS = 1000
--- A rung of more lines is none.
local MOST_LINES = 400

--- The lines without a blank one around a row: first from 0, and the lines.
local function rung(buffer, row)
  local first = math.max(0, row - MOST_LINES)
  local lines = vim.api.nvim_buf_get_lines(buffer, first, row + MOST_LINES, false)
  local at = row - first + 1
  local from, to = at, at
  while from > 1 and not lines[from - 1]:match('^%s*$') do
    from = from - 1
  end
  while to < #lines and not lines[to + 1]:match('^%s*$') do
    to = to + 1
  end
  return first + from - 1, vim.list_slice(lines, from, to)
end

--- The lines after edits of the server, in which line 0 is `first`.
local function edited(lines, first, edits, encoding)
  local text = vim.deepcopy(lines)
  table.sort(edits, function(a, b)
    local left, right = a.range.start, b.range.start
    return left.line > right.line or (left.line == right.line and left.character > right.character)
  end)
  for _, edit in ipairs(edits) do
    local from, to = edit.range.start, edit.range['end']
    local head, tail = text[from.line - first + 1], text[to.line - first + 1]
    if not head or not tail then
      return nil
    end
    local whole = head:sub(1, client.byte(head, from.character, encoding))
      .. edit.newText
      .. tail:sub(client.byte(tail, to.character, encoding) + 1)
    local index = from.line - first + 1
    for _ = from.line, to.line do
      table.remove(text, index)
    end
    for offset, line in ipairs(vim.split(whole, '\n', { plain = true })) do
      table.insert(text, index + offset - 1, line)
    end
  end
  return text
end

--- What the rung is to be after `characters`, which end at a byte of a row. Answers its first line, the lines as they are
--- and as they are to be; nil if the server does not answer.
function M.answered(running, buffer, characters, row, byte)
  local first, before = rung(buffer, row)
  local index = row - first + 1
  local lines = vim.deepcopy(before)
  local start = byte - #table.concat(characters)
  if start < 0 or before[index]:sub(start + 1, byte) ~= table.concat(characters) then
    return nil
  end
  lines[index] = before[index]:sub(1, start) .. before[index]:sub(byte + 1)
  local encoding = running.offset_encoding
  for _, character in ipairs(characters) do
    local text = lines[index]
    lines[index] = text:sub(1, start) .. character .. text:sub(start + 1)
    start = start + #character
    local edits = client.request_sync(running, 'rungwise/typed', {
      textDocument = { uri = vim.uri_from_bufnr(buffer), version = vim.lsp.util.buf_versions[buffer] },
      lines = { first = first, ['end'] = first + #before, text = table.concat(lines, '\n') .. '\n' },
      position = { line = row, character = client.character(lines[index], start, encoding) },
      ch = character,
    }, PATIENCE_MS, buffer)
    lines = edits and edited(lines, first, edits, encoding)
    if not lines or #lines ~= #before then
      return nil
    end
  end
  return first, before, lines
end

return M
