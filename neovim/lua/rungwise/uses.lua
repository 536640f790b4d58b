--- The uses of a device in the quickfix list.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

--- What is done, by the word of the server for it.
local function access(word)
  local words = {
    read = t('read'), write = t('written'), ['read-write'] = t('read and written'), define = t('defined'),
    jump = t('jumped to'),
  }
  return words[word] or word
end

--- Gives the lines of files, each read once: of the buffer where there is one, else from the disk.
local function reader()
  local files = {}
  return function(uri, line)
    if not files[uri] then
      local path = vim.uri_to_fname(uri)
      local buffer = vim.fn.bufnr('^' .. vim.fn.fnameescape(path) .. '$')
      if buffer ~= -1 and vim.api.nvim_buf_is_loaded(buffer) then
        files[uri] = vim.api.nvim_buf_get_lines(buffer, 0, -1, false)
      else
        files[uri] = vim.fn.filereadable(path) == 1 and vim.fn.readfile(path) or {}
      end
    end
    return files[uri][line] or ''
  end
end

--- The uses of a row of `rungwise.usage` as entries of the quickfix list.
local function entries(row)
  local line_of = reader()
  return vim.tbl_map(function(use)
    -- Columns are counted in Unicode scalar values.
    local byte = client.byte(line_of(use.uri, use.line), use.column - 1, 'utf-32')
    local rung = type(use.rung) == 'number' and t('rung %d', use.rung) .. ', ' or ''
    return {
      filename = vim.uri_to_fname(use.uri),
      lnum = use.line,
      col = byte + 1,
      text = rung .. access(use.access) .. ': ' .. use.text,
    }
  end, row.uses)
end

--- Lists the places where a device, an address or a variable is used; the one at the cursor if none is named.
function M.list(name)
  local buffer = vim.api.nvim_get_current_buf()
  local running = client.expect(buffer)
  if not running then
    return
  end
  local wish = { text = false }
  if name and name ~= '' then
    wish.devices = { name }
  else
    wish.position = vim.lsp.util.make_position_params(0, running.offset_encoding).position
  end
  local params = { command = 'rungwise.usage', arguments = { vim.uri_from_bufnr(buffer), wish } }
  client.request(running, 'workspace/executeCommand', params, function(err, result)
    local row = type(result) == 'table' and (result.devices or {})[1]
    if err then
      client.notify(err.message or vim.inspect(err), vim.log.levels.ERROR)
    elseif not row then
      client.notify(name and t('the program does not use "%s"', name) or t('no device at the cursor; name one'),
        vim.log.levels.WARN)
    else
      vim.fn.setqflist({}, ' ', { title = t('Uses of %s', row.device), items = entries(row) })
      vim.cmd('botright copen')
    end
  end, buffer)
end

return M
