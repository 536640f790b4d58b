--- The commands of the server's code actions that show a translation: in a new buffer beside, or in the registers.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

--- Commands of the client that the server may put into code actions; it learns of them in `initialize`.
M.commands = { 'rungwise.openTranslation', 'rungwise.copyTranslation' }

local FILETYPES = { ladder = 'ladder', fx = 'plc-il', iec = 'plc-il' }

local function say(message, level)
  vim.notify('Rungwise: ' .. message, level or vim.log.levels.INFO)
end

--- Asks for what a code action stands for, and hands its first form to `use`.
local function with_translation(command, context, use)
  local running = vim.lsp.get_client_by_id(context.client_id)
  if not running then
    return
  end
  local params = { command = 'rungwise.translate', arguments = command.arguments }
  client.request(running, 'workspace/executeCommand', params, function(err, result)
    local form = not err and type(result) == 'table' and type(result.forms) == 'table' and result.forms[1] or nil
    if err then
      say(t('nothing was translated: %s', err.message or vim.inspect(err)), vim.log.levels.ERROR)
    elseif not form then
      say(t('There is no rung at the cursor.'))
    else
      use(form)
      if type(form.notes) == 'table' and #form.notes > 0 then
        say(t('not everything was translated: %s', table.concat(form.notes, '; ')), vim.log.levels.WARN)
      end
    end
  end, context.bufnr)
end

--- A new buffer without a name: what becomes of it is the user's choice.
local function open(form)
  vim.cmd('rightbelow vnew')
  vim.api.nvim_buf_set_lines(0, 0, -1, false, vim.split((form.text:gsub('\n$', '')), '\n'))
  vim.bo.filetype = FILETYPES[form.to] or ''
end

--- Into the register of the clipboard, where there is one, and the one that `p` puts.
local function copy(form)
  vim.fn.setreg('"', form.text, 'l')
  if vim.fn.has('clipboard') == 1 then
    vim.fn.setreg('+', form.text, 'l')
  end
  say(t('the translation is in the registers " and +'))
end

--- Makes Neovim know the commands.
function M.register()
  vim.lsp.commands['rungwise.openTranslation'] = function(command, context)
    with_translation(command, context, open)
  end
  vim.lsp.commands['rungwise.copyTranslation'] = function(command, context)
    with_translation(command, context, copy)
  end
end

--- The capabilities of the client with these commands.
function M.capabilities()
  local own = { experimental = { commands = { commands = M.commands } } }
  return vim.tbl_deep_extend('force', vim.lsp.protocol.make_client_capabilities(), own)
end

return M
