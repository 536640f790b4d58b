-- The tests in a real Neovim. Run by neovim/run.sh as
--   nvim --headless --clean --cmd 'set runtimepath^=PLUGIN' -c 'luafile tests.lua'
-- in a copy of the fixtures, with the environment variable RUNGWISE_SERVER set.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish
local TIMEOUT_MS = 15000
local LADDER = 'three_mistakes.lad'
local THREE = { 'mixed-connection', 'open-circuit', 'short-circuit' }
local expected = vim.json.decode(table.concat(vim.fn.readfile('expected.json'), '\n'))

local function until_true(what, probe)
  if not vim.wait(TIMEOUT_MS, probe, 20) then
    error(('waited %d ms for %s; diagnostics: %s'):format(TIMEOUT_MS, what, vim.inspect(vim.tbl_map(function(d)
      return ('%s %d:%d %s'):format(d.code, d.lnum, d.col, d.message)
    end, vim.diagnostic.get(0)))), 0)
  end
end

--- Opens a file as it is on the disk; without wiping, a buffer that an earlier test changed would come back changed.
local function open(name)
  if vim.fn.bufexists(name) == 1 then
    vim.cmd('silent bwipeout! ' .. name)
  end
  vim.cmd('silent edit ' .. name)
  until_true('the client', function()
    return #vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' }) == 1
  end)
  return vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' })[1]
end

local function errors()
  return vim.diagnostic.get(0, { severity = vim.diagnostic.severity.ERROR })
end

local function codes()
  local found = vim.tbl_map(function(d)
    return d.code
  end, errors())
  table.sort(found)
  return found
end

--- Waits for exactly these errors, and that they stay.
local function until_codes(wanted)
  local function same()
    return vim.deep_equal(codes(), wanted)
  end
  until_true('exactly ' .. (#wanted > 0 and table.concat(wanted, ', ') or 'no errors'), same)
  vim.wait(200)
  assert(same(), 'the errors changed afterwards: ' .. table.concat(codes(), ', '))
end

local function assert_cells(name)
  for _, d in ipairs(errors()) do
    local cells = assert(expected[name][d.code], 'not expected: ' .. tostring(d.code))
    local inside = d.lnum >= cells.lines[1] and d.lnum <= cells.lines[2] and d.col >= cells.columns[1] and d.col <= cells.columns[2]
    assert(inside, ('%s at %d:%d'):format(d.code, d.lnum, d.col))
    assert(d.end_lnum > d.lnum or d.end_col > d.col, d.code .. ' marks no cell')
  end
end

--- Types keys as a person does, mappings included.
local function type_keys(keys)
  vim.api.nvim_feedkeys(vim.api.nvim_replace_termcodes(keys, true, false, true), 'mtx', false)
end

--- Puts the cursor on a word: line from 1, column from 0.
local function put_cursor(pattern)
  vim.fn.cursor(1, 1)
  assert(vim.fn.search(pattern, 'c') > 0, pattern .. ' is not in the buffer')
end

local function request(client, method, params)
  params = params or vim.lsp.util.make_position_params(0, client.offset_encoding)
  local answer = assert(client:request_sync(method, params, TIMEOUT_MS, 0), method .. ': no answer')
  assert(not answer.err, vim.inspect(answer.err))
  return answer.result
end

local function buffer_text()
  return table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
end

check('files get their types and options', function()
  open('conveyor_fx.il')
  assert(vim.bo.filetype == 'plc-il', vim.bo.filetype)
  assert(vim.bo.commentstring == '// %s')
  open(LADDER)
  assert(vim.bo.filetype == 'ladder', vim.bo.filetype)
  assert(vim.wo.virtualedit == 'block' and not vim.wo.wrap and vim.bo.expandtab)
  put_cursor('X10')
  assert(vim.fn.expand('<cword>') == 'X10')
end)

check('the server offers positions in bytes, and one client serves all buffers', function()
  local client = open(LADDER)
  assert(client.offset_encoding == 'utf-8', client.offset_encoding)
  open('conveyor_fx.il')
  assert(#vim.lsp.get_clients({ name = 'rungwise' }) == 1)
end)

check('a short circuit, an open circuit and a bridge are the three errors of a ladder, at their cells', function()
  open(LADDER)
  until_codes(THREE)
  assert_cells(LADDER)
end)

check('drawing the missing wire clears the open circuit and nothing else; undo brings it back', function()
  open(LADDER)
  until_codes(THREE)
  vim.fn.cursor(13, 17)
  type_keys('R----<Esc>')
  assert(vim.fn.getline(13):sub(1, 21) == '+---| |-------------+', vim.fn.getline(13))
  until_codes({ 'mixed-connection', 'short-circuit' })
  assert_cells(LADDER)
  type_keys('u')
  until_codes(THREE)
end)

check('taking the bypass wire away clears the short circuit and nothing else', function()
  open(LADDER)
  until_codes(THREE)
  vim.api.nvim_buf_set_text(0, 5, 16, 5, 17, { ' ' })
  vim.api.nvim_buf_set_text(0, 6, 0, 6, 17, { '|' .. (' '):rep(16) })
  until_codes({ 'mixed-connection', 'open-circuit' })
end)

check('an instruction list gets its errors at their words, and loses them by correct words', function()
  open('mistakes_fx.il')
  until_codes({ 'octal-digit', 'unknown-instruction' })
  assert_cells('mistakes_fx.il')
  put_cursor('MOVE')
  type_keys('cwMOV<Esc>')
  until_codes({ 'octal-digit' })
  put_cursor('X8')
  type_keys('cwX7<Esc>')
  until_codes({})
end)

check('clean programs have no errors', function()
  for _, name in ipairs({ 'conveyor_fx.il', 'mixer_iec.il', 'ragged.lad' }) do
    open(name)
    until_codes({})
  end
end)

check('hover explains instructions and devices', function()
  local client = open('conveyor_fx.il')
  for _, word in ipairs({ 'MOV', 'T0' }) do
    put_cursor('\\<' .. word .. '\\>')
    local result = request(client, 'textDocument/hover')
    assert(vim.inspect(result.contents):find(word, 1, true), vim.inspect(result))
  end
  open(LADDER)
  put_cursor('X11')
  assert(vim.inspect(request(client, 'textDocument/hover').contents):find('X11', 1, true))
end)

check('completion by CTRL-X CTRL-O offers instructions', function()
  open('conveyor_fx.il')
  assert(vim.bo.omnifunc == 'v:lua.vim.lsp.omnifunc', vim.bo.omnifunc)
  local client = vim.lsp.get_clients({ bufnr = 0 })[1]
  vim.api.nvim_buf_set_lines(0, 9, 9, false, { 'MO' })
  vim.fn.cursor(10, 2)
  local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
  params.position.character = 2
  local result = request(client, 'textDocument/completion', params)
  local labels = vim.tbl_map(function(item)
    return item.label
  end, result.items or result)
  assert(vim.list_contains(labels, 'MOV'), 'no MOV among ' .. #labels .. ' items')
end)

check('formatting straightens a ladder, once and for all', function()
  open('ragged.lad')
  vim.lsp.buf.format({ timeout_ms = TIMEOUT_MS })
  local once = buffer_text()
  local rails = {}
  for _, line in ipairs(vim.split(once, '\n')) do
    if line:match('^[|+]') then
      rails[vim.fn.strdisplaywidth(line)] = true
    end
  end
  assert(vim.tbl_count(rails) == 1, once)
  for _, name in ipairs({ 'X0', 'X1', 'X2', 'Y0', 'T0', 'K50', 'MOV K10 D0', 'END' }) do
    assert(once:find(name, 1, true), name .. ' is lost:\n' .. once)
  end
  until_codes({})
  vim.lsp.buf.format({ timeout_ms = TIMEOUT_MS })
  assert(buffer_text() == once, 'a second run changes something')
end)

check('rename changes every use of a variable', function()
  open('mixer_iec.il')
  local uses = select(2, buffer_text():gsub('Motor', ''))
  put_cursor('ST \\zsMotor')
  vim.lsp.buf.rename('Pump')
  until_true('the new name', function()
    return select(2, buffer_text():gsub('Pump', '')) == uses
  end)
  assert(not buffer_text():find('Motor', 1, true), buffer_text())
  until_codes({})
end)

check('the definition of a variable is found', function()
  open('mixer_iec.il')
  until_codes({})
  put_cursor('ST \\zsMotor')
  vim.lsp.buf.definition()
  until_true('the jump', function()
    return vim.fn.line('.') == vim.fn.search('Motor AT', 'nw')
  end)
end)

check(':RungwiseCheck shows a summary', function()
  open('conveyor_fx.il')
  until_codes({})
  local said
  local notify = vim.notify
  vim.notify = function(message)
    said = message
  end
  vim.cmd('RungwiseCheck')
  vim.wait(TIMEOUT_MS, function()
    return said ~= nil
  end)
  vim.notify = notify
  assert(said and said:match('^Rungwise: check passed: %d+ rungs, 15 of %d+ steps'), tostring(said))
end)

check('the status line shows target and steps, and follows :RungwiseTarget', function()
  open('conveyor_fx.il')
  local function statusline()
    return require('rungwise').statusline()
  end
  until_true('FX2N', function()
    return statusline():match('^FX2N · FX · 15/%d+ steps$')
  end)
  vim.cmd('RungwiseTarget fx3u')
  until_true('FX3U', function()
    return statusline():match('^FX3U ')
  end)
  vim.cmd('RungwiseTarget auto')
  until_true('FX2N', function()
    return statusline():match('^FX2N ')
  end)
end)

check(':RungwiseRestart leaves one client, which knows the open programs', function()
  local before = open(LADDER).id
  vim.cmd('RungwiseRestart')
  until_true('another client', function()
    local clients = vim.lsp.get_clients({ name = 'rungwise' })
    return #clients == 1 and clients[1].id ~= before
  end)
  until_codes(THREE)
end)

check('the devices in use are shown below, and anew when asked again', function()
  open('conveyor_fx.il')
  until_codes({})
  local program = vim.api.nvim_get_current_win()
  local function shown(pattern)
    vim.api.nvim_set_current_win(program)
    vim.cmd('Rungwise usage')
    until_true('the table with ' .. pattern, function()
      return vim.bo.filetype == 'rungwise-usage' and buffer_text():find(pattern)
    end)
  end
  shown('\nT0%s+ro%s')
  assert(not vim.bo.modifiable)
  vim.api.nvim_set_current_win(program)
  vim.api.nvim_buf_set_lines(0, 2, 2, false, { 'LD M7', 'OUT Y7' })
  shown('\nM0%s[^\n]*r%-')
  assert(#vim.api.nvim_list_wins() == 2, 'a second window')
  type_keys('q')
  assert(#vim.api.nvim_list_wins() == 1 and vim.bo.filetype == 'plc-il')
end)

check('the uses of a device are listed in the quickfix list', function()
  open('conveyor_fx.il')
  until_codes({})
  local function listed(command, title)
    vim.fn.setqflist({}, 'f')
    vim.cmd(command)
    until_true(title, function()
      return vim.fn.getqflist({ title = true }).title == title
    end)
    local places = vim.tbl_map(function(item)
      local text = vim.api.nvim_buf_get_lines(item.bufnr, item.lnum - 1, item.lnum, false)[1]
      return ('%d %s | %s'):format(item.lnum, text:sub(item.col), item.text)
    end, vim.fn.getqflist())
    vim.cmd('cclose')
    return places
  end
  -- At the Y0 of `1 OR Y0`.
  vim.api.nvim_win_set_cursor(0, { 4, 5 })
  local uses = { '4 Y0 | rung 1, read: 1 OR Y0', '6 Y0 | rung 1, written: 3 OUT Y0', '7 Y0 | rung 2, read: 4 LD Y0' }
  assert(vim.deep_equal(listed('Rungwise uses', 'Uses of Y0'), uses), vim.inspect(vim.fn.getqflist()))
  assert(vim.deep_equal(listed('Rungwise uses t0', 'Uses of T0'), {
    '8 T0 K50 | rung 2, written: 5 OUT T0 K50', '9 T0 | rung 3, read: 8 LD T0',
  }), vim.inspect(vim.fn.getqflist()))
  local said
  local notify = vim.notify
  vim.notify = function(message)
    said = message
  end
  vim.cmd('Rungwise uses Y7')
  until_true('a word about a device that is not used', function()
    return said
  end)
  vim.notify = notify
  assert(said:find('does not use "Y7"', 1, true), said)
end)

--- A list that the server knows.
local function open_list(name)
  vim.fn.writefile({ 'LD X0', 'LD X1', 'OR X2', 'ANB', 'OUT Y0', 'LD X5', 'OUT Y5', 'END' }, name)
  local client = open(name)
  until_codes({})
  return client
end

--- Does the code action of a kind at the cursor, as `gra` does with the one that is chosen.
local function act(kind)
  local done
  vim.lsp.buf.code_action({
    context = { only = { kind }, diagnostics = {} },
    filter = function(action)
      done = done or action.kind == kind
      return action.kind == kind
    end,
    apply = true,
  })
  until_true('an action of the kind ' .. kind, function()
    return done
  end)
end

check('a rung is opened in another form beside the program, or copied', function()
  open_list('translated.il')
  put_cursor('OR X2')
  act('refactor.rewrite.translate.boolean')
  until_true('the boolean form', function()
    return buffer_text() == 'Y0 = X0*(X1 + X2)'
  end)
  assert(vim.api.nvim_buf_get_name(0) == '' and #vim.api.nvim_list_wins() == 2)
  vim.cmd('bwipeout!')
  act('source.translate.ladder')
  until_true('the drawing', function()
    return vim.bo.filetype == 'ladder' and buffer_text():find('Y5', 1, true)
  end)
  vim.cmd('bwipeout!')
  vim.fn.setreg('"', '')
  act('refactor.rewrite.translate.boolean.copy')
  until_true('the register', function()
    return vim.fn.getreg('"') == 'Y0 = X0*(X1 + X2)\n'
  end)
end)

check('a refactoring that saves steps is applied', function()
  open_list('refactored.il')
  put_cursor('LD X0')
  act('refactor.rewrite.rung.wideFirst')
  until_true('the shorter list', function()
    return buffer_text():find('LD X1\nOR X2\nAND X0\nOUT Y0\n', 1, true)
  end)
end)

check('the forms of a rung follow the cursor with the real server', function()
  open_list('forms.il')
  local function page()
    local buffer = vim.fn.bufnr('rungwise://forms')
    return buffer ~= -1 and table.concat(vim.api.nvim_buf_get_lines(buffer, 0, -1, false), '\n') or ''
  end
  put_cursor('OUT Y0')
  vim.cmd('RungwiseForms')
  until_true('all forms of the first rung', function()
    local text = page()
    return text:find('Y0 = X0*(X1 + X2)', 1, true) and text:find('proved equal', 1, true) and text:find('( )', 1, true)
  end)
  put_cursor('OUT Y5')
  vim.api.nvim_exec_autocmds('CursorMoved', {})
  until_true('the next rung', function()
    return page():find('Y5 = X5', 1, true) and not page():find('X1 + X2', 1, true)
  end)
  vim.cmd('bwipeout! rungwise://forms')
end)

check('nvim-dap is told of the adapter, and the adapter answers', function()
  -- A stub with the two tables that nvim-dap has for adapters and configurations.
  local mine = { type = 'other', name = 'mine' }
  local stub = { adapters = {}, configurations = { ladder = { mine } } }
  package.loaded.dap = stub
  local dap = require('rungwise.dap')
  assert(dap.setup() and dap.setup(), 'nvim-dap is there')
  package.loaded.dap = nil
  assert(vim.deep_equal(stub.configurations.ladder[1], mine), 'what the user has configured stays')
  for _, filetype in ipairs({ 'ladder', 'plc-il' }) do
    local own = stub.configurations[filetype]
    local last = own[#own]
    assert(#own == (filetype == 'ladder' and 2 or 1), 'one configuration: ' .. vim.inspect(own))
    assert(last.type == 'rungwise' and last.request == 'launch' and last.program == '${file}', vim.inspect(last))
  end
  local adapter
  stub.adapters.rungwise(function(given)
    adapter = given
  end)
  assert(adapter.type == 'executable' and adapter.command == vim.env.RUNGWISE_SERVER, vim.inspect(adapter))
  local body = vim.json.encode({ seq = 1, type = 'request', command = 'initialize', arguments = { adapterID = 'rungwise' } })
  local command = vim.list_extend({ adapter.command }, adapter.args)
  local input = ('Content-Length: %d\r\n\r\n%s'):format(#body, body)
  local answer = vim.system(command, { stdin = input, text = true, timeout = TIMEOUT_MS }):wait()
  assert(answer.code == 0 and answer.stdout:find('"supportsStepBack":true', 1, true), vim.inspect(answer))
end)

check('each file of a program shows the one simulation of it, in two windows at once', function()
  local simulation = require('rungwise.simulation')
  vim.fn.mkdir('line', 'p')
  vim.fn.writefile({ 'target = "fx2n"', 'files = ["first.il", "second.lad"]' }, 'line/rungwise.toml')
  vim.fn.writefile({ 'LD X0', 'CALL P1', 'FEND' }, 'line/first.il')
  vim.fn.writefile({
    'P1:', '|   X1       Y0 |', '+---| |-----( )-+', '', '+--[SRET]-------+', '', '+--[END]--------+',
  }, 'line/second.lad')
  vim.cmd('silent edit line/first.il')
  local first = vim.api.nvim_get_current_buf()
  until_true('the first file', function()
    return #vim.lsp.get_clients({ bufnr = first, name = 'rungwise' }) == 1
  end)
  vim.cmd('Rungwise simulate')
  until_true('the simulation', function()
    return simulation.running[vim.uri_from_bufnr(first)] ~= nil
  end)
  -- A file that is opened later belongs to it.
  vim.cmd('silent split line/second.lad')
  local second = vim.api.nvim_get_current_buf()
  until_true('the other file', function()
    return simulation.running[vim.uri_from_bufnr(second)] ~= nil
  end)
  vim.cmd('Rungwise simulate set X0 1')
  vim.cmd('Rungwise simulate set X1 1')
  local function has_power(buffer, line)
    local space = vim.api.nvim_get_namespaces().rungwise_simulation
    local marks = vim.api.nvim_buf_get_extmarks(buffer, space, { line, 0 }, { line, -1 }, { details = true })
    return vim.iter(marks):any(function(mark)
      return mark[4].hl_group == 'RungwiseEnergised' and mark[4].end_col > 5
    end)
  end
  until_true('power in both', function()
    return has_power(first, 1) and has_power(second, 2)
  end)
  -- Without the first file it goes on, and it is stopped from the other one.
  vim.cmd('bdelete! ' .. first)
  vim.cmd('Rungwise simulate set X1 0')
  until_true('the coil off', function()
    return not vim.iter(vim.api.nvim_buf_get_extmarks(second, vim.api.nvim_get_namespaces().rungwise_simulation, { 2, 0 }, { 2, -1 }, { details = true }))
      :any(function(mark)
        return mark[4].hl_group == 'RungwiseEnergised' and mark[4].end_col > 13
      end)
  end)
  vim.cmd('silent split line/first.il')
  first = vim.api.nvim_get_current_buf()
  until_true('the first file again', function()
    return simulation.running[vim.uri_from_bufnr(first)] ~= nil and has_power(first, 1)
  end)
  vim.cmd('Rungwise simulate stop')
  assert(next(simulation.running) == nil, vim.inspect(simulation.running))
  vim.cmd('silent! bdelete! ' .. first .. ' ' .. second)
end)

check('a program runs, holds itself, shows its power and goes back', function()
  open('motor.lad')
  local simulation = require('rungwise.simulation')
  local space = vim.api.nvim_get_namespaces().rungwise_simulation
  --- The cells of a line, from 1, that have power, as text.
  local function energised(line)
    local cells = {}
    for _, found in ipairs(vim.api.nvim_buf_get_extmarks(0, space, { line - 1, 0 }, { line - 1, -1 }, { details = true })) do
      if found[4].hl_group == 'RungwiseEnergised' then
        table.insert(cells, vim.fn.getline(line):sub(found[3] + 1, found[4].end_col))
      end
    end
    return table.concat(cells)
  end
  local function has_coil(line)
    return energised(line):find('( )', 1, true) ~= nil
  end
  vim.cmd('Rungwise simulate')
  until_true('power at the rail', function()
    return energised(3):find('---', 1, true) and not has_coil(3)
  end)
  vim.cmd('Rungwise simulate set X0 1')
  until_true('the motor on', function()
    return has_coil(3)
  end)
  vim.cmd('Rungwise simulate set X0 0')
  until_true('the motor held by its own contact', function()
    return has_coil(3) and energised(5):find('| |', 1, true) and not energised(3):find('| |', 1, true)
  end)
  until_true('the value of the timer', function()
    local marks = vim.api.nvim_buf_get_extmarks(0, space, { 6, 0 }, { 6, -1 }, { details = true })
    return vim.iter(marks):any(function(found)
      return found[4].virt_text and found[4].virt_text[1][1] == 'T0 = 10'
    end)
  end)
  -- What is forced is marked wherever it is named: a letter beside the line, lines below the name, words behind it.
  vim.cmd('Rungwise simulate force Y0 1')
  local function forced(line)
    local found = { signs = 0, names = {}, words = '' }
    for _, own in ipairs(vim.api.nvim_buf_get_extmarks(0, space, { line - 1, 0 }, { line - 1, -1 }, { details = true })) do
      local details = own[4]
      found.signs = found.signs + (vim.trim(details.sign_text or '') == 'F' and 1 or 0)
      found.words = found.words .. (details.virt_text and details.virt_text[1][1] or '')
      if details.hl_group == 'RungwiseForcedName' then
        table.insert(found.names, vim.fn.getline(line):sub(own[3] + 1, details.end_col))
      end
    end
    return found
  end
  until_true('the forced coil and its contacts', function()
    local coil, contact = forced(2), forced(4)
    return vim.deep_equal(coil.names, { 'Y0' }) and coil.signs == 1 and coil.words == 'Y0 forced to 1'
      and vim.deep_equal(contact.names, { 'Y0' })
  end)
  vim.cmd('Rungwise simulate release Y0')
  until_true('nothing forced', function()
    return #forced(2).names == 0 and forced(2).signs == 0
  end)
  local running = simulation.running[vim.uri_from_bufnr(0)]
  -- To before the scan in which the motor came on.
  vim.cmd('Rungwise simulate back Y0')
  until_true('the motor off again, in a scan of before', function()
    return running.mode == 'paused' and not has_coil(3)
  end)
  -- Why it is off: in a floating window, from which Enter goes to the contact.
  vim.cmd('Rungwise simulate why Y0')
  local function floating()
    return vim.iter(vim.api.nvim_list_wins()):find(function(window)
      return vim.api.nvim_win_get_config(window).relative ~= ''
    end)
  end
  until_true('the reasons', floating)
  local window = floating()
  local reasons = vim.api.nvim_buf_get_lines(vim.api.nvim_win_get_buf(window), 0, -1, false)
  assert(reasons[1]:find('^Y0 is off: %( %) Y0 has no power  %[line 3%]'), vim.inspect(reasons))
  assert(reasons[2]:find('X0 is off: an input', 1, true), vim.inspect(reasons))
  vim.api.nvim_set_current_win(window)
  vim.api.nvim_win_set_cursor(window, { 2, 0 })
  vim.api.nvim_feedkeys(vim.keycode('<CR>'), 'xt', false)
  until_true('the contact', function()
    return not floating() and vim.fn.bufname() == 'motor.lad' and vim.fn.line('.') == 3
  end)
  local scan = running.scan
  vim.cmd('Rungwise simulate step')
  until_true('one scan more', function()
    return running.scan == scan + 1
  end)
  vim.cmd('Rungwise simulate stop')
  until_true('a text without power', function()
    return #vim.api.nvim_buf_get_extmarks(0, space, 0, -1, {}) == 0
  end)
end)

check('a program goes into a PLC after a look at what changes, and its power is shown', function()
  local listening
  local plc = vim.system({ vim.env.RUNGWISE_SERVER, 'plc', '--listen', '127.0.0.1:0' }, {
    stdin = true,
    text = true,
    stdout = function(_, data)
      listening = listening or data and data:match('tcp://%S+')
    end,
  })
  until_true('a virtual PLC', function()
    return listening
  end)
  open('motor.lad')
  local program = vim.api.nvim_get_current_buf()
  local state = function()
    return require('rungwise.plc').state
  end
  vim.cmd('Rungwise plc connect ' .. listening)
  until_true('the connection', function()
    return state().connected
  end)
  local questions = {}
  local confirm = vim.fn.confirm
  vim.fn.confirm = function(question)
    table.insert(questions, question)
    return 1
  end
  vim.cmd('Rungwise plc download start')
  until_true('the PLC in RUN with the program', function()
    return #questions == 1 and state().mode == 'RUN' and state().sum ~= 'E0D0'
  end)
  vim.fn.confirm = confirm
  assert(questions[1]:find('machine may move', 1, true), questions[1])
  -- What changes stands side by side in a tab of its own.
  local shown = vim.tbl_map(vim.api.nvim_win_get_buf, vim.api.nvim_tabpage_list_wins(0))
  assert(#shown == 2 and vim.wo.diff, vim.inspect(shown))
  local before, after = unpack(vim.tbl_map(function(buffer)
    return table.concat(vim.api.nvim_buf_get_lines(buffer, 0, -1, false), '\n')
  end, shown))
  assert(before:find('[END]', 1, true) and not before:find('( )', 1, true) and after:find('( )', 1, true), before .. after)
  vim.cmd.tabclose()
  assert(vim.api.nvim_get_current_buf() == program)
  local space = vim.api.nvim_get_namespaces().rungwise_simulation
  local function has_coil()
    local marks = vim.api.nvim_buf_get_extmarks(0, space, { 2, 0 }, { 2, -1 }, { details = true })
    return vim.iter(marks):any(function(found)
      local cells = vim.fn.getline(3):sub(found[3] + 1, found[4].end_col or found[3])
      return found[4].hl_group == 'RungwiseEnergised' and cells:find('( )', 1, true) ~= nil
    end)
  end
  vim.cmd('Rungwise plc monitor')
  until_true('power at the rail', function()
    return #vim.api.nvim_buf_get_extmarks(0, space, 0, -1, {}) > 0
  end)
  assert(not has_coil())
  vim.cmd('Rungwise plc force X0 1')
  until_true('the motor on in the PLC', has_coil)
  -- The table of what the program uses and of a register that it does not, with what they are in the PLC.
  vim.cmd('Rungwise plc table')
  local shown_panel = vim.api.nvim_get_current_buf()
  local function line_of(name)
    for number, line in ipairs(vim.api.nvim_buf_get_lines(shown_panel, 0, -1, false)) do
      if line:find(' ' .. name .. ' ', 1, true) then
        return line, number
      end
    end
  end
  until_true('the motor on in the table', function()
    return (line_of('Y0') or ''):find('●') ~= nil
  end)
  local input = vim.ui.input
  local typed = 'd100'
  vim.ui.input = function(_, done)
    done(typed)
  end
  vim.api.nvim_feedkeys('a', 'xt', false)
  until_true('a row for D100', function()
    return line_of('D100') ~= nil
  end)
  vim.fn.confirm = function(question)
    table.insert(questions, question)
    return 1
  end
  local _, number = line_of('D100')
  vim.api.nvim_win_set_cursor(0, { number, 0 })
  typed = '-2'
  vim.api.nvim_feedkeys('=', 'xt', false)
  until_true('the number in the PLC', function()
    return (line_of('D100') or ''):find(' -2', 1, true) ~= nil
  end)
  assert(#questions == 2 and questions[2]:find('may move', 1, true), vim.inspect(questions))
  vim.api.nvim_feedkeys('v', 'xt', false)
  until_true('the number in hexadecimal', function()
    return (line_of('D100') or ''):find('HFFFE', 1, true) ~= nil
  end)
  vim.api.nvim_feedkeys('f', 'xt', false)
  until_true('the mark of what is held', function()
    return (line_of('D100') or ''):find('[forced]', 1, true) ~= nil and #(state().held or {}) == 1
  end)
  vim.api.nvim_feedkeys('r', 'xt', false)
  until_true('nothing held', function()
    return (line_of('D100') or ''):find('[forced]', 1, true) == nil and #state().held == 0
  end)
  vim.fn.confirm = confirm
  vim.ui.input = input
  vim.cmd.close()
  vim.api.nvim_set_current_buf(program)
  local recorded = vim.fn.tempname() .. '.csv'
  vim.cmd('Rungwise plc record ' .. recorded .. ' D100')
  until_true('a file of what was seen', function()
    return vim.fn.filereadable(recorded) == 1
  end)
  local rows = vim.fn.readfile(recorded)
  assert(rows[1] == 'scan,time_ms,D100' and vim.iter(rows):any(function(row)
    return row:find(',-2$') ~= nil
  end), vim.inspect(rows))
  vim.cmd('Rungwise plc stop')
  until_true('the PLC in STOP', function()
    return state().mode == 'STOP' and not has_coil()
  end)
  vim.cmd('Rungwise plc monitor')
  until_true('a text without power', function()
    return #vim.api.nvim_buf_get_extmarks(0, space, 0, -1, {}) == 0
  end)
  vim.cmd('Rungwise plc upload')
  until_true('the program of the PLC', function()
    return vim.fn.getline(1) == 'LD X0' and vim.fn.getline('$') == 'END'
  end)
  vim.cmd.bwipeout({ bang = true })
  plc:kill('sigkill')
  until_true('the loss of the line', function()
    return not state().connected
  end)
end)

check('scenario tests fill the quickfix list, and what was done becomes one', function()
  local folder = vim.fn.tempname()
  vim.fn.mkdir(folder)
  vim.fn.writefile({ 'LD X0', 'OR Y0', 'ANI X1', 'OUT Y0', 'END' }, folder .. '/line.il')
  local function scenarios(expected)
    return {
      '[[scenario]]', 'name = "starts"',
      ('steps = [{ at = 50, set = { X0 = 1 }, expect = { Y0 = %d } }]'):format(expected),
    }
  end
  vim.fn.writefile(scenarios(0), folder .. '/line.test.toml')
  local function edit(name)
    vim.cmd.edit(folder .. '/' .. name)
    until_true('a server for the file', function()
      return #vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' }) == 1
    end)
  end
  edit('line.test.toml')
  vim.fn.setqflist({}, 'f')
  vim.cmd('Rungwise test')
  local list
  until_true('a failure in the list', function()
    list = vim.fn.getqflist()
    return #list > 1
  end)
  assert(vim.fn.bufname(list[1].bufnr):find('line.test.toml', 1, true), vim.inspect(list[1]))
  assert(list[1].lnum == 3 and list[1].col == 50, vim.inspect(list[1]))
  assert(list[1].text:find('starts: Y0 is 1 where 0 was expected', 1, true), list[1].text)
  assert(vim.iter(list):any(function(item)
    return item.text:find('^^^', 1, true)
  end), vim.inspect(list))
  -- Mended, from the program: the list is empty again.
  vim.api.nvim_buf_set_lines(0, 0, -1, false, scenarios(1))
  vim.cmd.write()
  edit('line.il')
  vim.cmd('Rungwise test starts')
  until_true('an empty list', function()
    return #vim.fn.getqflist() == 0
  end)
  vim.cmd('Rungwise simulate')
  local simulation = require('rungwise.simulation')
  until_true('a simulation', function()
    return simulation.running[vim.uri_from_bufnr(0)] ~= nil
  end)
  vim.cmd('Rungwise simulate set X0 1')
  vim.cmd('Rungwise simulate step')
  vim.cmd('Rungwise simulate record')
  until_true('a scenario test of its own name', function()
    return vim.api.nvim_buf_get_name(0):find('line-2.test.toml', 1, true) ~= nil
  end)
  assert(buffer_text():find('set = { X0 = 1 }, expect = { Y0 = 1 }', 1, true), buffer_text())
  vim.cmd('bwipeout!')
  vim.cmd('Rungwise simulate stop')
end)

check('two programs are compared with the real server', function()
  local other = vim.fn.tempname() .. '.il'
  vim.fn.writefile({ 'LD X0', 'OUT Y7', 'END' }, other)
  open_list('forms.il')
  vim.cmd('Rungwise prove ' .. vim.fn.fnameescape(other))
  until_true('the page of the proof', function()
    return vim.api.nvim_buf_get_name(0):find('rungwise://proof', 1, true) and buffer_text():find('^# forms%.il · ')
  end)
  vim.cmd('bwipeout!')
end)

--- Has the server seem to know the translation, or not; answers what it is asked.
local function translating(client, answers)
  local commands = vim.tbl_filter(function(command)
    return command ~= 'rungwise.translate'
  end, client.server_capabilities.executeCommandProvider.commands)
  client.server_capabilities.executeCommandProvider.commands = commands
  if not answers then
    return
  end
  table.insert(commands, 'rungwise.translate')
  local plugin = require('rungwise.client')
  local fake = { asked = {}, cancelled = {}, request = plugin.request, cancel = plugin.cancel }
  plugin.request = function(_, method, params, callback)
    assert(method == 'workspace/executeCommand' and params.command == 'rungwise.translate')
    local argument = params.arguments[1]
    table.insert(fake.asked, { argument = argument, callback = callback })
    if answers ~= 'late' then
      callback(nil, answers(argument))
    end
    return #fake.asked
  end
  plugin.cancel = function(_, id)
    table.insert(fake.cancelled, id)
  end
  function fake.restore()
    plugin.request, plugin.cancel = fake.request, fake.cancel
  end
  return fake
end

local function page_text()
  local buffer = vim.fn.bufnr('rungwise://forms')
  return buffer ~= -1 and table.concat(vim.api.nvim_buf_get_lines(buffer, 0, -1, false), '\n') or ''
end

check('the forms of a rung stand beside it and follow the cursor', function()
  local client = open('conveyor_fx.il')
  translating(client, nil)
  vim.cmd('RungwiseForms')
  assert(#vim.api.nvim_list_wins() == 1 and page_text() == '', 'something is shown without a translation')
  local fake = translating(client, function(argument)
    local line = argument.position and argument.position.line or 'range ' .. argument.range.start.line
    return { forms = { { to = 'boolean', text = 'Y0 = line ' .. line .. '\n', certificate = 'proved', notes = { 'a note' } } } }
  end)
  vim.api.nvim_win_set_cursor(0, { 3, 0 })
  vim.cmd('Rungwise forms')
  assert(page_text() == '## Boolean form — proved equal\n\n```\nY0 = line 2\n```\n\n- a note\n', page_text())
  assert(vim.bo.filetype == 'plc-il' and #vim.api.nvim_list_wins() == 2, 'the cursor has left the program')
  vim.api.nvim_win_set_cursor(0, { 6, 0 })
  vim.api.nvim_exec_autocmds('CursorMoved', {})
  until_true('the other rung', function()
    return page_text():find('line 5', 1, true)
  end)
  assert(vim.deep_equal(fake.asked[#fake.asked].argument.to, 'all'))
  vim.cmd('normal! Vj')
  vim.api.nvim_exec_autocmds('CursorMoved', {})
  until_true('the selected rungs', function()
    return page_text():find('line range 5', 1, true)
  end)
  type_keys('<Esc>')
  -- Closed, nobody asks any more.
  vim.cmd('bwipeout! rungwise://forms')
  local before = #fake.asked
  vim.api.nvim_exec_autocmds('CursorMoved', {})
  vim.wait(300)
  assert(#fake.asked == before, 'a page that is closed is asked for')
  fake.restore()
end)

check('the forms of a rung that the cursor has left are not shown', function()
  local client = open('conveyor_fx.il')
  local fake = translating(client, 'late')
  vim.api.nvim_win_set_cursor(0, { 3, 0 })
  vim.cmd('RungwiseForms')
  vim.api.nvim_win_set_cursor(0, { 7, 0 })
  vim.api.nvim_exec_autocmds('CursorMoved', {})
  until_true('the second question', function()
    return #fake.asked == 2
  end)
  assert(vim.deep_equal(fake.cancelled, { 1 }), vim.inspect(fake.cancelled))
  fake.asked[2].callback(nil, { forms = { { to = 'fx', text = 'LD Y0', certificate = 'undecided', notes = {} } } })
  fake.asked[1].callback(nil, { forms = { { to = 'fx', text = 'LD X0', certificate = 'proved', notes = {} } } })
  assert(page_text() == '## Instruction list, FX — not decided\n\n```il\nLD Y0\n```\n', page_text())
  vim.cmd('bwipeout! rungwise://forms')
  fake.restore()
end)

check('code lenses come by a refresh, and follow the options', function()
  local client = open('conveyor_fx.il')
  local function titles()
    return table.concat(vim.tbl_map(function(lens)
      return lens.command and lens.command.title or ''
    end, vim.lsp.codelens.get(0)), ' | ')
  end
  local function refreshed(what, fits)
    until_true(what, function()
      vim.lsp.codelens.refresh({ bufnr = 0 })
      vim.wait(100)
      return fits(titles())
    end)
  end
  refreshed('all lenses', function(text)
    return text:find('next free: T1', 1, true) and text:find('4 steps', 1, true) and text:find('Y0: 2 references', 1, true)
  end)
  vim.g.rungwise = { codeLens = { steps = false, nextFree = false } }
  require('rungwise.client').send_settings()
  refreshed('references alone', function(text)
    return text:find('Y0: 2 references', 1, true) and not text:find('steps', 1, true) and not text:find('next free', 1, true)
  end)
  vim.g.rungwise = nil
  require('rungwise.client').send_settings()
  assert(client.id == vim.lsp.get_clients({ bufnr = 0 })[1].id)
end)

check('a drawing in a fence of a Markdown file is served, other Markdown is not', function()
  open('notes.md')
  until_codes({ 'short-circuit' })
  assert(errors()[1].lnum >= 5 and errors()[1].lnum <= 8, vim.inspect(errors()[1]))
  vim.cmd.edit('README.md')
  vim.wait(500)
  assert(#vim.lsp.get_clients({ name = 'rungwise', bufnr = 0 }) == 0, 'attached to a text without programs')
end)

check('a manifest is checked as it is typed, completed and explained; other TOML is not served', function()
  vim.cmd('silent edit other.toml')
  assert(vim.bo.filetype == 'toml')
  vim.fn.mkdir('manifest')
  vim.cmd('silent edit manifest/rungwise.toml')
  until_true('the client', function()
    return #vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' }) == 1
  end)
  local other = vim.fn.bufnr('other.toml')
  assert(#vim.lsp.get_clients({ bufnr = other, name = 'rungwise' }) == 0, 'other TOML is served')
  vim.api.nvim_buf_set_lines(0, 0, -1, false, { 'target = "fx9"' })
  until_true('the mistake', function()
    local found = vim.diagnostic.get(0)
    return #found == 1 and found[1].message:find('fx9', 1, true) and found[1].col == 10
  end)
  vim.api.nvim_buf_set_lines(0, 0, -1, false, { 'target = "fx2n"' })
  until_true('no mistake', function()
    return #vim.diagnostic.get(0) == 0
  end)
  local client = vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' })[1]
  local function params(column)
    return { textDocument = vim.lsp.util.make_text_document_params(0), position = { line = 0, character = column } }
  end
  local items = request(client, 'textDocument/completion', params(12))
  local labels = vim.tbl_map(function(item)
    return item.label
  end, items.items or items)
  assert(vim.list_contains(labels, 'fx3u'), vim.inspect(labels))
  local hover = request(client, 'textDocument/hover', params(2))
  assert(hover.contents.value:find('PLC model', 1, true), vim.inspect(hover))
  vim.cmd('silent bwipeout!')
end)

check(':RungwiseLog opens the log', function()
  vim.cmd('RungwiseLog')
  assert(vim.api.nvim_buf_get_name(0):match('lsp%.log$'), vim.api.nvim_buf_get_name(0))
  vim.cmd('tabclose')
end)

check(':checkhealth rungwise finds the server', function()
  vim.cmd('silent checkhealth rungwise')
  local text = buffer_text()
  assert(text:find('version %d+%.%d+%.%d+'), text)
  assert(not text:find('ERROR', 1, true), text)
  vim.cmd('bwipeout')
end)

check(':help rungwise opens, and every link in it leads somewhere', function()
  vim.cmd('help rungwise')
  assert(vim.bo.filetype == 'help')
  assert(buffer_text():find('PLC programs as text', 1, true))
  local links = {}
  for link in buffer_text():gmatch('|([^|%s]+)|') do
    -- The drawings of the page are full of bars that are no links.
    if link:find('%a') then
      links[link] = true
    end
  end
  for link in pairs(links) do
    assert(#vim.fn.getcompletion(link, 'help') > 0, 'no help for ' .. link)
  end
  vim.cmd('helpclose')
end)

finish()
