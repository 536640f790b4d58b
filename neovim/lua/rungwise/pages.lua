--- Windows with what the server writes: pages of rules and instructions, and the devices of a program.
local client = require('rungwise.client')
local words = require('rungwise.words')
local t = words.t
local M = {}

--- Shows text in a window below, which `q` closes. A window with the same name is used again.
local function show(name, filetype, text)
  local buffer = vim.fn.bufnr('^' .. vim.fn.escape(name, '[]*?{}') .. '$')
  if buffer == -1 then
    buffer = vim.api.nvim_create_buf(false, true)
    vim.api.nvim_buf_set_name(buffer, name)
    vim.bo[buffer].bufhidden = 'wipe'
    vim.keymap.set('n', 'q', '<Cmd>close<CR>', { buffer = buffer, desc = t('Close the page') })
  end
  vim.bo[buffer].modifiable = true
  vim.api.nvim_buf_set_lines(buffer, 0, -1, false, vim.split(vim.trim(text), '\n'))
  vim.bo[buffer].modifiable = false
  vim.bo[buffer].filetype = filetype
  local window = vim.fn.bufwinid(buffer)
  if window ~= -1 then
    vim.api.nvim_set_current_win(window)
  else
    vim.cmd('botright split')
    vim.api.nvim_win_set_buf(0, buffer)
    vim.wo.wrap = false
  end
end

--- The code of the diagnostic at the cursor, else the word there.
local function at_cursor()
  local row, column = unpack(vim.api.nvim_win_get_cursor(0))
  local here = vim.tbl_filter(function(d)
    local starts = d.lnum < row - 1 or (d.lnum == row - 1 and d.col <= column)
    local ends = d.end_lnum > row - 1 or (d.end_lnum == row - 1 and d.end_col > column)
    return d.source == 'rungwise' and starts and ends
  end, vim.diagnostic.get(0))
  table.sort(here, function(a, b)
    return a.severity < b.severity
  end)
  return here[1] and here[1].code or vim.fn.expand('<cword>')
end

--- Shows the page of a rule or an instruction; of what is at the cursor if none is named.
function M.explain(word)
  word = (word and word ~= '') and word or at_cursor()
  if not word or word == '' then
    client.notify(t('put the cursor on an instruction or an error, or name one'), vim.log.levels.WARN)
    return
  end
  local ok, answer = pcall(function()
    local language = words.language()
    local command = vim.list_extend({ client.server(), 'explain', word }, language and { '--lang', language } or {})
    return vim.system(command, { text = true, timeout = 10000 }):wait()
  end)
  if not ok then
    client.notify(tostring(answer), vim.log.levels.ERROR)
  elseif answer.code ~= 0 then
    local said = vim.split(answer.stderr or '', '\n')[1]:gsub('^error%[[%w-]+%]:%s*', '')
    client.notify(said, vim.log.levels.WARN)
  else
    show('rungwise://explain/' .. word, 'markdown', answer.stdout)
  end
end

--- Shows the table of the devices that the program in the buffer uses.
function M.usage()
  local buffer = vim.api.nvim_get_current_buf()
  local running = client.expect(buffer)
  if not running then
    return
  end
  local params = { command = 'rungwise.usage', arguments = { vim.uri_from_bufnr(buffer), { uses = false } } }
  client.request(running, 'workspace/executeCommand', params, function(err, result)
    if err then
      client.notify(err.message or vim.inspect(err), vim.log.levels.ERROR)
      return
    end
    local text = type(result) == 'table' and result.text or result
    local name = 'rungwise://usage/' .. vim.fs.basename(vim.api.nvim_buf_get_name(buffer))
    show(name, 'rungwise-usage', type(text) == 'string' and text or vim.inspect(result))
  end, buffer)
end

return M
