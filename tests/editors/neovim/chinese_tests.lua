-- A user who reads Chinese: the locale of the client, the plugin's own words, the help.
-- Run by neovim/run.sh in a copy of the fixtures; RUNGWISE_TEST_CASE says how the language is told.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish
local TIMEOUT_MS = 15000
local by_locale = vim.env.RUNGWISE_TEST_CASE == 'chinese_by_locale'
local words = require('rungwise.words')

if by_locale then
  -- As clients say it that send the user's locale; Neovim itself sends none.
  vim.lsp.config('rungwise', {
    before_init = function(params)
      params.locale = 'zh-CN'
    end,
  })
else
  vim.g.rungwise = { language = 'zh-CN' }
  vim.lsp.config('rungwise', require('rungwise.client').config())
end

local function open(name)
  vim.cmd('silent edit ' .. name)
  assert(vim.wait(TIMEOUT_MS, function()
    return #vim.diagnostic.get(0, { severity = vim.diagnostic.severity.ERROR }) > 0
  end, 20), 'no diagnostics')
end

check('a diagnostic is Chinese and stands at its cells', function()
  open('mistakes_fx.il')
  local found = vim.tbl_filter(function(d)
    return d.code == 'octal-digit'
  end, vim.diagnostic.get(0))
  assert(#found == 1, vim.inspect(vim.diagnostic.get(0)))
  assert(found[1].message == 'X8：输入和输出的编号为八进制，没有数字 8 和 9', found[1].message)
  assert(found[1].lnum == 3 and found[1].col == 3, vim.inspect(found[1]))
end)

check('a hover is Chinese', function()
  local client = vim.lsp.get_clients({ bufnr = 0, name = 'rungwise' })[1]
  vim.fn.cursor(5, 1)
  local params = vim.lsp.util.make_position_params(0, client.offset_encoding)
  local answer = assert(client:request_sync('textDocument/hover', params, TIMEOUT_MS, 0))
  local text = answer.result.contents.value
  assert(text:find('### OUT：线圈驱动', 1, true) and text:find('| 操作数 | 含义 | 可用 |', 1, true), text)
end)

if not by_locale then
  check('the plugin speaks Chinese as well', function()
    local said
    local notify = vim.notify
    vim.notify = function(message)
      said = message
    end
    require('rungwise.commands').target('fx9')
    vim.notify = notify
    assert(said:find('没有目标“fx9”；可用 auto, fx1s', 1, true), said)
    vim.wait(TIMEOUT_MS, function()
      return require('rungwise').statusline() ~= ''
    end, 20)
    assert(require('rungwise').statusline():find('步$'), require('rungwise').statusline())
  end)

  check(':checkhealth is Chinese', function()
    vim.cmd('silent checkhealth rungwise')
    local page = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
    assert(page:find('rungwise：服务器', 1, true) and page:find('由 RUNGWISE_SERVER 指定', 1, true), page)
    assert(not page:find('ERROR', 1, true), page)
    vim.cmd('silent bwipeout!')
  end)

  check('the page of a rule is Chinese', function()
    require('rungwise.pages').explain('open-circuit')
    local page = table.concat(vim.api.nvim_buf_get_lines(0, 0, -1, false), '\n')
    assert(page:find('有一端悬空', 1, true), page)
    vim.cmd('silent close')
  end)

  check('no word of the plugin lacks a translation, and none is left over', function()
    local used = {}
    for _, path in ipairs(vim.api.nvim_get_runtime_file('lua/rungwise/*.lua', true)) do
      local source = table.concat(vim.fn.readfile(path), '\n')
      for _, message in source:gmatch('%f[%w]t%(([\'"])(.-)%1') do
        used[message] = true
      end
    end
    used['around %s'], used['inner %s'] = true, true
    for _, edit in pairs(require('rungwise.edit').edits) do
      used[edit[3]] = true
    end
    for _, object in pairs(require('rungwise.textobjects').objects) do
      used[object] = true
    end
    assert(vim.tbl_count(used) > 50, vim.inspect(used))
    for message in pairs(used) do
      local chinese = words.chinese[message]
      assert(chinese, 'no translation: ' .. message)
      local function places(text)
        return vim.iter(text:gmatch('%%[sd]')):join(' ')
      end
      assert(places(chinese) == places(message), message)
    end
    for message in pairs(words.chinese) do
      assert(used[message], 'left over: ' .. message)
    end
  end)

  check('the help is there in Chinese, with every tag of the English one', function()
    vim.cmd('silent help rungwise-options@cn')
    assert(vim.api.nvim_buf_get_name(0):find('rungwise.cnx', 1, true), vim.api.nvim_buf_get_name(0))
    vim.cmd('silent helpclose')
    local folder = vim.fs.dirname(vim.api.nvim_get_runtime_file('doc/rungwise.txt', false)[1])
    local function tags(name)
      local text = table.concat(vim.fn.readfile(folder .. '/' .. name), '\n')
      local found = vim.iter(text:gmatch('%*([%w:_.-]+)%*')):totable()
      table.sort(found)
      return found
    end
    assert(vim.deep_equal(tags('rungwise.txt'), tags('rungwise.cnx')), vim.inspect(tags('rungwise.cnx')))
  end)
end

finish()
