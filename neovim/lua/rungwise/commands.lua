--- The commands :RungwiseCheck, :RungwiseRestart, :RungwiseLog and :RungwiseTarget.
local client = require('rungwise.client')
local M = {}

local TARGETS = { 'auto', 'fx1s', 'fx1n', 'fx2n', 'fx3u', 'iec' }

local function notify(message, level)
  vim.notify('Rungwise: ' .. message, level or vim.log.levels.INFO)
end

--- Runs the batch check on the program in the buffer and shows its summary.
function M.check()
  local buffer = vim.api.nvim_get_current_buf()
  local running = client.clients(buffer)[1]
  if not running then
    notify('no language server for this buffer; see :checkhealth rungwise', vim.log.levels.ERROR)
    return
  end
  local params = { command = 'rungwise.check', arguments = { vim.uri_from_bufnr(buffer) } }
  client.request(running, 'workspace/executeCommand', params, function(err, result)
    if err then
      notify('the program was not checked: ' .. (err.message or vim.inspect(err)), vim.log.levels.ERROR)
    else
      local message = type(result) == 'table' and result.message or result
      notify(type(message) == 'string' and message or 'the server gave no result of the check')
    end
  end, buffer)
end

--- Opens the log of the language clients at its end.
function M.log()
  local path = vim.lsp.log and vim.lsp.log.get_filename and vim.lsp.log.get_filename() or vim.lsp.get_log_path()
  vim.cmd.tabedit(vim.fn.fnameescape(path))
  vim.cmd.normal({ 'G', bang = true })
end

--- Sets the PLC model that programs are checked for, for this session; without a name it says which one is in force.
function M.target(name)
  if name == '' then
    local status = client.status[vim.uri_from_bufnr(0)]
    notify('target PLC ' .. (status and tostring(status.target) or 'unknown'))
    return
  end
  if not vim.list_contains(TARGETS, name) then
    notify(('there is no target "%s"; known are %s'):format(name, table.concat(TARGETS, ', ')), vim.log.levels.ERROR)
    return
  end
  local options = client.options()
  options.target = name ~= 'auto' and name or nil
  vim.g.rungwise = options
  client.send_settings()
end

function M.create()
  local command = vim.api.nvim_create_user_command
  command('RungwiseCheck', M.check, { desc = 'Check the program in this buffer' })
  command('RungwiseRestart', client.restart, { desc = 'Restart the Rungwise language server' })
  command('RungwiseLog', M.log, { desc = 'Open the log of the language server' })
  command('RungwiseTarget', function(arguments)
    M.target(arguments.args)
  end, {
    desc = 'Set the target PLC',
    nargs = '?',
    complete = function(start)
      return vim.tbl_filter(function(name)
        return vim.startswith(name, start)
      end, TARGETS)
    end,
  })
end

return M
