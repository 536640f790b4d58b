-- What works without `vim.lsp.enable` (Neovim 0.10), and without any server.
-- Run by neovim/run.sh; the environment variable RUNGWISE_TEST_CASE says which case.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish

local function group_at(line, text)
  local column = assert(vim.fn.getline(line):find(text, 1, true), text .. ' is not in line ' .. line)
  return vim.fn.synIDattr(vim.fn.synID(line, column, 1), 'name')
end

local function assert_groups(groups)
  for _, entry in ipairs(groups) do
    local line, text, group = unpack(entry)
    assert(group_at(line, text) == group, ('line %d: %s is "%s", not %s'):format(line, text, group_at(line, text), group))
  end
end

if vim.env.RUNGWISE_TEST_CASE == 'without_enable' then
  check('without vim.lsp.enable the server is started by vim.lsp.start', function()
    assert(vim.lsp.enable == nil, 'this Neovim was not reduced')
    vim.cmd('silent edit three_mistakes.lad')
    assert(vim.wait(15000, function()
      return #vim.diagnostic.get(0, { severity = vim.diagnostic.severity.ERROR }) == 3
    end, 20), 'no diagnostics')
  end)
else
  check('a missing server is told once, when a program is opened', function()
    local said = {}
    local notify = vim.notify
    vim.notify = function(message)
      table.insert(said, message)
    end
    vim.cmd('silent edit conveyor_fx.il')
    vim.cmd('silent edit mixer_iec.il')
    vim.notify = notify
    assert(#said == 1 and said[1]:find('no language server at "/nowhere/rungwise"', 1, true), vim.inspect(said))
  end)

  check('the fallback syntax colours an FX list', function()
    vim.cmd('silent edit conveyor_fx.il')
    assert(vim.b.current_syntax == 'plc-il')
    assert_groups({
      { 1, 'dialect', 'rungwiseComment' },
      { 3, 'X0', 'rungwiseDevice' },
      { 3, '0', 'rungwiseStep' },
      { 5, 'ANI', 'rungwiseMnemonic' },
      { 8, 'K50', 'rungwiseNumber' },
      { 10, 'MOV', 'rungwiseMnemonic' },
    })
    vim.api.nvim_buf_set_lines(0, 2, 3, false, { 'ANDD>= D0 K4M0 ; why' })
    assert_groups({
      { 3, 'ANDD>=', 'rungwiseMnemonic' },
      { 3, '>=', 'rungwiseMnemonic' },
      { 3, 'K4M0', 'rungwiseDevice' },
      { 3, 'why', 'rungwiseComment' },
    })
  end)

  check('the fallback syntax colours an IEC program', function()
    vim.cmd('silent edit! mixer_iec.il')
    assert_groups({
      { 1, 'mixer', 'rungwiseComment' },
      { 2, 'PROGRAM', 'rungwiseKeyword' },
      { 3, 'VAR', 'rungwiseKeyword' },
      { 4, '%IX0.0', 'rungwiseAddress' },
      { 4, 'BOOL', 'rungwiseType' },
      { 7, 'TON', 'rungwiseBlock' },
      { 11, 'ANDN', 'rungwiseOperator' },
      { 14, 'IN', 'rungwiseParameter' },
      { 15, 'T#5s', 'rungwiseNumber' },
      { 19, 'END_PROGRAM', 'rungwiseKeyword' },
    })
  end)

  check('the fallback syntax colours a ladder', function()
    vim.cmd('silent edit ragged.lad')
    assert(vim.b.current_syntax == 'ladder')
    assert_groups({
      { 1, 'seal', 'rungwiseComment' },
      { 2, 'X0', 'rungwiseDevice' },
      { 3, '---', 'rungwiseWire' },
      { 3, '| |', 'rungwiseContact' },
      { 3, '|/|', 'rungwiseContact' },
      { 3, '( )', 'rungwiseCoil' },
      { 11, 'MOV', 'rungwiseBoxWord' },
      { 11, 'K10', 'rungwiseNumber' },
      { 11, 'D0', 'rungwiseDevice' },
    })
  end)

  check(':checkhealth rungwise says what to do', function()
    vim.cmd('silent checkhealth rungwise')
    local text = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
    assert(text:find('/nowhere/rungwise', 1, true) and text:find('cargo build', 1, true), text)
  end)
end

finish()
