--- The command :Rungwise with its subcommands, and :RungwiseCheck, :RungwiseForms, :RungwiseRestart, :RungwiseLog, :RungwiseTarget.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

local TARGETS = { 'auto', 'fx1s', 'fx1n', 'fx2n', 'fx3u', 'iec' }

local notify = client.notify

--- Runs the batch check on the program in the buffer and shows its summary.
function M.check()
  local buffer = vim.api.nvim_get_current_buf()
  local running = client.expect(buffer)
  if not running then
    return
  end
  local params = { command = 'rungwise.check', arguments = { vim.uri_from_bufnr(buffer) } }
  client.request(running, 'workspace/executeCommand', params, function(err, result)
    if err then
      notify(t('the program was not checked: %s', err.message or vim.inspect(err)), vim.log.levels.ERROR)
    else
      local message = type(result) == 'table' and result.message or result
      notify(type(message) == 'string' and message or t('the server gave no result of the check'))
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
    notify(t('target PLC %s', status and tostring(status.target) or t('unknown')))
    return
  end
  if not vim.list_contains(TARGETS, name) then
    notify(t('there is no target "%s"; known are %s', name, table.concat(TARGETS, ', ')), vim.log.levels.ERROR)
    return
  end
  local options = client.options()
  options.target = name ~= 'auto' and name or nil
  vim.g.rungwise = options
  client.send_settings()
end

local function matching(start, words)
  return vim.tbl_filter(function(word)
    return vim.startswith(word, start)
  end, words)
end

--- The subcommands of :Rungwise: what they do with the words behind them, and what completes the first of these.
M.subcommands = {
  check = { run = M.check },
  edit = {
    run = function(words)
      local operand = table.concat(vim.list_slice(words, 2), ' ')
      require('rungwise.edit').run(words[1] or '', operand ~= '' and operand or nil)
    end,
    complete = function()
      return require('rungwise.edit').names()
    end,
  },
  explain = {
    run = function(words)
      require('rungwise.pages').explain(words[1])
    end,
    complete = function()
      local codes = vim.tbl_map(function(d)
        return d.code
      end, vim.diagnostic.get(0))
      table.sort(codes)
      return vim.fn.uniq(codes)
    end,
  },
  forms = {
    run = function()
      require('rungwise.forms').open()
    end,
  },
  health = {
    run = function()
      vim.cmd.checkhealth('rungwise')
    end,
  },
  log = { run = M.log },
  plc = {
    run = function(words)
      require('rungwise.plc').run(words)
    end,
    complete = function()
      return require('rungwise.plc').names()
    end,
  },
  prove = {
    run = function(words)
      require('rungwise.pages').prove(table.concat(words, ' '))
    end,
    complete = function(start)
      return vim.fn.getcompletion(start, 'file')
    end,
  },
  restart = { run = client.restart },
  simulate = {
    run = function(words)
      require('rungwise.simulation').run(words)
    end,
    complete = function()
      return require('rungwise.simulation').names()
    end,
  },
  target = {
    run = function(words)
      M.target(words[1] or '')
    end,
    complete = function()
      return TARGETS
    end,
  },
  test = {
    run = function(words)
      require('rungwise.testing').run(table.concat(words, ' '))
    end,
  },
  usage = {
    run = function()
      require('rungwise.pages').usage()
    end,
  },
  uses = {
    run = function(words)
      require('rungwise.uses').list(words[1])
    end,
  },
}

local function subcommand_names()
  local names = vim.tbl_keys(M.subcommands)
  table.sort(names)
  return names
end

--- Runs `:Rungwise NAME WORD…`.
function M.run(arguments)
  local words = vim.list_slice(arguments.fargs, 2)
  local name = arguments.fargs[1]
  local subcommand = M.subcommands[name]
  if subcommand then
    subcommand.run(words)
  else
    notify(t('there is no ":Rungwise %s"; there are %s', name, table.concat(subcommand_names(), ', ')),
      vim.log.levels.ERROR)
  end
end

--- Completes the name of the subcommand, then its first word.
function M.complete(start, line)
  local words = vim.split(line:gsub('^.-Rungwise%s+', ''), '%s+')
  if #words <= 1 then
    return matching(start, subcommand_names())
  end
  local subcommand = M.subcommands[words[1]]
  return #words == 2 and subcommand and subcommand.complete and matching(start, subcommand.complete(start)) or {}
end

--- What lenses do: the same as the commands, which show more than the server alone can.
local LENSES = {
  ['rungwise.simulate.start'] = function()
    require('rungwise.simulation').run({})
  end,
  ['rungwise.test.run'] = function(command)
    local names = command.arguments[1].names or {}
    require('rungwise.testing').run(names[1] or '')
  end,
}

function M.create()
  local command = vim.api.nvim_create_user_command
  for name, run in pairs(LENSES) do
    vim.lsp.commands[name] = run
  end
  command('Rungwise', M.run, {
    desc = t('Check, edit, explain: what Rungwise can do'), nargs = '+', range = true, complete = M.complete,
  })
  command('RungwiseCheck', M.check, { desc = t('Check the program in this buffer') })
  command('RungwiseForms', function()
    require('rungwise.forms').open()
  end, { desc = t('Show the forms of the rung at the cursor') })
  command('RungwiseRestart', client.restart, { desc = t('Restart the Rungwise language server') })
  command('RungwiseLog', M.log, { desc = t('Open the log of the language server') })
  command('RungwiseTarget', function(arguments)
    M.target(arguments.args)
  end, {
    desc = t('Set the target PLC'),
    nargs = '?',
    complete = function(start)
      return matching(start, TARGETS)
    end,
  })
end

return M
