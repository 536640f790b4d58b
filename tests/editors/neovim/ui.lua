--- A Neovim with a user interface of its own, driven by keys: insert mode, autocommands and timers run as for a person.
local M = {}
M.__index = M

local TIMEOUT_MS = 30000

--- Starts it with the plugin of the parent, which stands first on its runtime path.
function M.start()
  local plugin = vim.opt.runtimepath:get()[1]
  local command = { vim.v.progpath, '--embed', '--clean', '--cmd', 'set runtimepath^=' .. plugin .. ' noswapfile' }
  local self = setmetatable({ channel = vim.fn.jobstart(command, { rpc = true }) }, M)
  self:request('nvim_ui_attach', 100, 40, { rgb = true })
  return self
end

function M:request(method, ...)
  return vim.rpcrequest(self.channel, method, ...)
end

--- Runs Lua in it; the arguments are `...` there.
function M:lua(code, ...)
  return self:request('nvim_exec_lua', code, { ... })
end

--- Waits until `probe` gives something true, and gives that.
function M:until_true(what, probe)
  local found
  if not vim.wait(TIMEOUT_MS, function()
    found = probe()
    return found
  end, 10) then
    error(('waited %d ms for %s; the buffer:\n%s'):format(TIMEOUT_MS, what, self:text()), 0)
  end
  return found
end

--- Presses keys, as |nvim_input()| writes them, and waits until they are all taken.
function M:press(keys)
  local left = #keys
  while left > 0 do
    left = left - self:request('nvim_input', keys:sub(#keys - left + 1))
  end
  -- Neovim answers a blocked request when it waits: for keys again, or in an autocommand for an answer of the server.
  -- Keys that come in the latter case may be read together, and those that a mapping feeds, as a jump in a snippet does,
  -- then stand behind them.
  self:until_true('the keys to be taken', function()
    return self:request('nvim_eval', "state('x')") == ''
  end)
end

--- Types text key by key, as a person does, and lets the server answer after each.
function M:type(text)
  for _, character in ipairs(vim.fn.split(text, '\\zs')) do
    self:press(character == '<' and '<lt>' or character == '\n' and '<CR>' or character)
    self:settle()
  end
end

--- Waits until no request is under way, no autocommand waits for one, and the text stands still.
function M:settle()
  local last
  self:until_true('the answers of the server', function()
    local tick, pending, idle = unpack(self:lua([[
      local count = 0
      for _, client in ipairs(vim.lsp.get_clients({ bufnr = 0 })) do
        count = count + vim.tbl_count(client.requests or {})
      end
      return { vim.api.nvim_buf_get_changedtick(0), count, vim.fn.state('x') == '' }
    ]]))
    local still = idle and pending == 0 and tick == last
    last = idle and tick or nil
    return still
  end)
end

function M:text()
  return table.concat(self:request('nvim_buf_get_lines', 0, 0, -1, false), '\n')
end

--- Writes a program, opens it and puts the cursor at a line and a column, both from 0.
function M:open(name, text, line, column)
  vim.fn.writefile(vim.split(text, '\n'), name)
  self:lua('vim.cmd("silent! %bwipeout!"); vim.cmd.edit(...)', vim.fn.fnamemodify(name, ':p'))
  self:until_true('the client', function()
    return self:lua("return #vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' }) == 1")
  end)
  self:request('nvim_win_set_cursor', 0, { (line or 0) + 1, column or 0 })
  self:settle()
end

--- Codes of the diagnostics in alphabetical order.
function M:codes()
  return self:lua([[
    local codes = vim.tbl_map(function(d) return d.code end, vim.diagnostic.get(0))
    table.sort(codes)
    return codes
  ]])
end

function M:stop()
  vim.fn.jobstop(self.channel)
end

return M
