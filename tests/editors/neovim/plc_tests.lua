-- A PLC on a line in a real Neovim: what differs from it, and ending what takes long. Run by neovim/run.sh.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish
local TIMEOUT_MS = 15000
local messages = {}
local program

vim.notify = function(message)
  table.insert(messages, message)
end

local function until_true(what, probe)
  if not vim.wait(TIMEOUT_MS, probe, 20) then
    error(('waited %d ms for %s; messages: %s'):format(TIMEOUT_MS, what, vim.inspect(messages)), 0)
  end
end

local function is_told(text)
  return function()
    return vim.iter(messages):any(function(message)
      return message:find(text, 1, true) ~= nil
    end)
  end
end

--- A virtual PLC, and where it listens.
local function start_plc(...)
  local listening
  local plc = vim.system({ vim.env.RUNGWISE_SERVER, 'plc', '--listen', '127.0.0.1:0', ... }, {
    stdin = true,
    text = true,
    stdout = function(_, data)
      listening = listening or data and data:match('tcp://%S+')
    end,
  })
  until_true('a virtual PLC', function()
    return listening
  end)
  return plc, listening
end

local function state()
  return require('rungwise.plc').state
end

--- Opens a program of these lines, connected to a PLC.
local function open(name, lines, port)
  vim.fn.writefile(lines, name)
  vim.cmd('silent edit ' .. name)
  program = vim.api.nvim_get_current_buf()
  until_true('the client', function()
    return #vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' }) == 1
  end)
  vim.cmd('Rungwise plc connect ' .. port)
  until_true('the connection', function()
    return state().connected
  end)
end

--- The lines with the sign of what differs, from 1.
local function drifted()
  local space = vim.api.nvim_get_namespaces().rungwise_drift
  return vim.tbl_map(function(mark)
    return mark[2] + 1
  end, vim.api.nvim_buf_get_extmarks(program, space, 0, -1, {}))
end

local function until_drifted(lines)
  until_true('drift in ' .. vim.inspect(lines), function()
    return vim.deep_equal(drifted(), lines)
  end)
end

--- Changes the text as somebody who types; there is no main loop that would tell so.
local function edit(command)
  vim.cmd(command)
  vim.api.nvim_exec_autocmds('TextChanged', { buffer = program })
end

vim.fn.confirm = function()
  return 1
end

check('lines that are not so in the PLC are marked, and the status line says so', function()
  local plc, port = start_plc()
  open('drift.il', { 'LD X0', 'OUT Y0', 'LD X1', 'OUT Y1', 'END' }, port)
  local statusline = require('rungwise').statusline
  until_true('the mode in the status line', function()
    return statusline():find('PLC RUN', 1, true) ~= nil
  end)
  assert(vim.deep_equal(drifted(), {}), 'nothing was compared yet')
  vim.cmd('Rungwise plc verify')
  until_drifted({ 1, 2, 3, 4 })
  vim.cmd.tabclose()
  until_true('the sign in the status line', function()
    return statusline():match('PLC RUN ≠$') ~= nil
  end)
  vim.cmd('Rungwise plc download start')
  until_true('the download', is_told('read back and compared'))
  vim.cmd.tabclose()
  until_drifted({})
  until_true('no sign in the status line', function()
    return statusline():match('PLC RUN$') ~= nil
  end)
  edit("call setline(3, 'LDI X1')")
  until_drifted({ 3 })
  local space = vim.api.nvim_get_namespaces().rungwise_drift
  local mark = vim.api.nvim_buf_get_extmarks(0, space, 0, -1, { details = true })[1][4]
  assert(vim.trim(mark.sign_text) == '≠' and mark.virt_text[1][1]:find('not so in the PLC', 1, true), vim.inspect(mark))
  edit('silent undo')
  until_drifted({})
  edit("call setline(3, 'LDI X1')")
  until_drifted({ 3 })
  -- The table says of how many scans its values may be.
  vim.cmd('Rungwise plc table')
  until_true('a row', function()
    return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n'):find('Y0', 1, true) ~= nil
  end)
  local names = vim.tbl_map(function(number)
    return 'D' .. number
  end, vim.fn.range(40))
  local told = 0
  until_true('the exchanges of a look', function()
    -- What the table asks for when its rows have come takes the place of what was asked before.
    if vim.uv.now() - told > 1000 then
      told = vim.uv.now()
      require('rungwise.plc').tell(program, 'monitor', { names = names })
    end
    return (vim.api.nvim_buf_get_lines(0, 0, 1, false)[1] or ''):find('values of up to 2 scans', 1, true) ~= nil
  end)
  vim.cmd.close()
  vim.api.nvim_set_current_buf(program)
  plc:kill('sigkill')
  until_drifted({})
  until_true('a status line without a PLC', function()
    return statusline():find('PLC', 1, true) == nil
  end)
end)

check('what takes long is ended by a key or a command, and what has become of the PLC is told', function()
  messages = {}
  -- As slow as a real line, so that there is time.
  local plc, port = start_plc('--baud', '9600')
  local lines = {}
  for number = 0, 299 do
    vim.list_extend(lines, { 'LD M' .. number, 'OUT M' .. number + 1 })
  end
  open('cancelled.il', vim.list_extend(lines, { 'END' }), port)
  vim.keymap.set('n', '<C-c>', '<Nop>', { buffer = 0, desc = 'own' })
  local has_begun = false
  local heard = vim.api.nvim_create_autocmd('LspProgress', {
    callback = function(event)
      local value = event.data.params.value
      has_begun = has_begun or (value.message or ''):find('writing: ', 1, true) ~= nil
    end,
  })
  vim.cmd('Rungwise plc download')
  until_true('something that was written', function()
    return has_begun
  end)
  vim.api.nvim_del_autocmd(heard)
  vim.cmd.tabclose()
  assert(vim.api.nvim_get_current_buf() == program)
  vim.api.nvim_feedkeys(vim.keycode('<C-c>'), 'xm', false)
  until_true('what has become of the PLC', is_told('written in part'))
  assert(not is_told('read back and compared')())
  until_true('the mapping as before', function()
    return vim.fn.maparg('<C-c>', 'n', false, true).desc == 'own'
  end)
  until_true('the PLC in STOP', function()
    return state().mode == 'STOP'
  end)
  -- Another thing that takes long, ended by the command.
  messages = {}
  vim.cmd('Rungwise plc upload')
  vim.cmd('Rungwise plc verify')
  assert(is_told('something else goes on')())
  vim.cmd('Rungwise plc cancel')
  until_true('the end of it', function()
    messages = {}
    vim.cmd('Rungwise plc cancel')
    return is_told('nothing goes on')()
  end)
  assert(vim.api.nvim_get_current_buf() == program)
  plc:kill('sigkill')
  until_true('the loss of the line', function()
    return not state().connected
  end)
end)

finish()
